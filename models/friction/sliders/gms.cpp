#include "limcycle/models/friction/sliders/gms.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Gms<double>&);

}  // namespace limcycle
