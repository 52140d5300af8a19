#include "limcycle/models/element/with_memory/delayed_relay.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const DelayedRelay<double>&);

}  // namespace limcycle
