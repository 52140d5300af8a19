#include "limcycle/models/friction/dry/dithered_coulomb.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const DitheredCoulomb<double>&);

}  // namespace limcycle
