#include "limcycle/cli/units_of.hpp"

#include "limcycle/cases/case.hpp"

namespace limcycle {

Units units_of(const LoopParts& loop) {
  const auto plant = kind_of(loop.plant);
  if (plant == "froude-pendulum") return {"rad", loop.friction ? "N" : "N m", loop.friction ? "m" : "rad"};
  const bool mechanical = loop.friction || plant == "mass" || plant == "belt" || plant == "two-mass";
  return mechanical ? Units{} : Units{"", "", ""};
}

}  // namespace limcycle
