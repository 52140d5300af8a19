#include "limcycle/models/element/with_memory/valve_stiction.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const ValveStiction<double>&);

}  // namespace limcycle
