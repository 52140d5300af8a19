#include "limcycle/models/friction/sliders/maxwell_slip.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const MaxwellSlip<double>&);

}  // namespace limcycle
