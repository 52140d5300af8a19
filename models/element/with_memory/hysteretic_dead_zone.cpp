#include "limcycle/models/element/with_memory/hysteretic_dead_zone.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const HystereticDeadZone<double>&);

}  // namespace limcycle
