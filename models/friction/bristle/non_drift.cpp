#include "limcycle/models/friction/bristle/non_drift.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const NonDrift<double>&);

}  // namespace limcycle
