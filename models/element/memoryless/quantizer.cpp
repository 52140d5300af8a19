#include "limcycle/models/element/memoryless/quantizer.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Quantizer<double>&);

}  // namespace limcycle
