#include "limcycle/models/element/memoryless/saturation.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Saturation<double>&);

}  // namespace limcycle
