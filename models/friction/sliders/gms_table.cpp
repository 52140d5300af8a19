#include "limcycle/models/friction/sliders/gms_table.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const GmsTable<double>&);

}  // namespace limcycle
