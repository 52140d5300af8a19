#include "limcycle/models/element/of_controllers/impulses.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Impulses<double>&);

}  // namespace limcycle
