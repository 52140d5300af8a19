#include "limcycle/models/friction/bristle/lugre_table.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const LuGreTable<double>&);

}  // namespace limcycle
