#include "limcycle/models/element/memoryless/cubic.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Cubic<double>&);

}  // namespace limcycle
