#include "limcycle/models/element/with_memory/rate_limit.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const RateLimit<double>&);

}  // namespace limcycle
