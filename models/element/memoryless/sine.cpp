#include "limcycle/models/element/memoryless/sine.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Sine<double>&);

}  // namespace limcycle
