#include "limcycle/models/friction/sliders/xiong.hpp"

#include "limcycle/models/element/element_face.hpp"

namespace limcycle {

template std::shared_ptr<ElementFace> face_of(const Xiong<double>&);

}  // namespace limcycle
