#include "limcycle/models/element/of_controllers/reset_integrator.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const ResetIntegrator<double>&);

}  // namespace limcycle
