#include "limcycle/models/element/reset_integrator.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const ResetIntegrator<double>&);

}  // namespace limcycle
