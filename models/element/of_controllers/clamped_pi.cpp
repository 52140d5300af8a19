#include "limcycle/models/element/of_controllers/clamped_pi.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const ClampedPi<double>&);

}  // namespace limcycle
