#include "limcycle/models/friction/dry/wojewoda.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Wojewoda<double>&);

}  // namespace limcycle
