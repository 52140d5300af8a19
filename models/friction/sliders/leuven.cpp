#include "limcycle/models/friction/sliders/leuven.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Leuven<double>&);

}  // namespace limcycle
