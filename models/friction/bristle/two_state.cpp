#include "limcycle/models/friction/bristle/two_state.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const TwoState<double>&);

}  // namespace limcycle
