#include "limcycle/models/friction/bristle/lugre.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const LuGre<double>&);

}  // namespace limcycle
