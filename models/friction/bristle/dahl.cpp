#include "limcycle/models/friction/bristle/dahl.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Dahl<double>&);

}  // namespace limcycle
