#include "limcycle/models/element/of_controllers/stop_reset_integrator.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const StopResetIntegrator<double>&);

}  // namespace limcycle
