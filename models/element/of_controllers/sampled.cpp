#include "limcycle/models/element/of_controllers/sampled.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Sampled<double>&);

}  // namespace limcycle
