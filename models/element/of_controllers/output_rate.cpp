#include "limcycle/models/element/of_controllers/output_rate.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const OutputRate<double>&);

}  // namespace limcycle
