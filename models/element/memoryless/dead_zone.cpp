#include "limcycle/models/element/memoryless/dead_zone.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const DeadZone<double>&);

}  // namespace limcycle
