#include "limcycle/models/friction/dry/quinn.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Quinn<double>&);

}  // namespace limcycle
