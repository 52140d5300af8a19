#include "limcycle/cli/units_of.hpp"

#include "limcycle/cases/loader/case.hpp"

namespace limcycle {

Units units_of(const LoopParts& loop) {
  const auto plant = kind_of(loop.plant);
  if (plant == "froude-pendulum") return {"rad", loop.friction ? "N" : "N m", loop.friction ? "m" : "rad"};
  if (const auto* named = std::get_if<StateSpacePlant>(&loop.plant); named != nullptr && loop.friction) {
    const PlantModel model = named->model();
    if (model.C_x != model.C_y) return {"", "N", "m"};  // the output is not the rubbing displacement: a flow, an angle
  }
  const bool mechanical = loop.friction || plant == "mass" || plant == "belt" || plant == "two-mass";
  return mechanical ? Units{} : Units{"", "", ""};
}

}  // namespace limcycle
