#include "limcycle/models/element/memoryless/gravity.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Gravity<double>&);

}  // namespace limcycle
