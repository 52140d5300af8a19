#include "limcycle/models/element/with_memory/backlash.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Backlash<double>&);

}  // namespace limcycle
