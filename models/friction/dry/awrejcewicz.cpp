#include "limcycle/models/friction/dry/awrejcewicz.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Awrejcewicz<double>&);

}  // namespace limcycle
