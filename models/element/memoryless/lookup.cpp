#include "limcycle/models/element/memoryless/lookup.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Lookup<double>&);

}  // namespace limcycle
