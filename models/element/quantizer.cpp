#include "limcycle/models/element/quantizer.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Quantizer<double>&);

}  // namespace limcycle
