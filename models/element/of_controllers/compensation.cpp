#include "limcycle/models/element/of_controllers/compensation.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Compensation<double>&);

}  // namespace limcycle
