#include "limcycle/models/friction/sliders/iwan.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Iwan<double>&);

}  // namespace limcycle
