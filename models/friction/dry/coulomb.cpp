#include "limcycle/models/friction/dry/coulomb.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Coulomb<double>&);

}  // namespace limcycle
