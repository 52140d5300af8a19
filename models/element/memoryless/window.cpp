#include "limcycle/models/element/memoryless/window.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Window<double>&);

}  // namespace limcycle
