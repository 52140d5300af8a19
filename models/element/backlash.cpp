#include "limcycle/models/element/backlash.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Backlash<double>&);

}  // namespace limcycle
