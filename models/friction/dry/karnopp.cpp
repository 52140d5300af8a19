#include "limcycle/models/friction/dry/karnopp.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Karnopp<double>&);

}  // namespace limcycle
