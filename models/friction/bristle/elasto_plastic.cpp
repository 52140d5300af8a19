#include "limcycle/models/friction/bristle/elasto_plastic.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const ElastoPlastic<double>&);

}  // namespace limcycle
