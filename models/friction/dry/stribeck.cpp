#include "limcycle/models/friction/dry/stribeck.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Stribeck<double>&);

}  // namespace limcycle
