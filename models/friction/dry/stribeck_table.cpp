#include "limcycle/models/friction/dry/stribeck_table.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const StribeckTable<double>&);

}  // namespace limcycle
