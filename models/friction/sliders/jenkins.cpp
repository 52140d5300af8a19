#include "limcycle/models/friction/sliders/jenkins.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Jenkins<double>&);

}  // namespace limcycle
