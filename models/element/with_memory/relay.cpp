#include "limcycle/models/element/with_memory/relay.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Relay<double>&);

}  // namespace limcycle
