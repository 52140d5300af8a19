#include "limcycle/models/element/compensation.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Compensation<double>&);

}  // namespace limcycle
