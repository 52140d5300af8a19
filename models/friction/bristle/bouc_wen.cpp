#include "limcycle/models/friction/bristle/bouc_wen.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const BoucWen<double>&);

}  // namespace limcycle
