#include "limcycle/models/friction/dry/kikuuwe.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Kikuuwe<double>&);

}  // namespace limcycle
