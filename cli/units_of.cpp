#include "limcycle/cli/units_of.hpp"

#include "limcycle/cases/case.hpp"

namespace limcycle {

Units units_of(const LoopParts& loop) {
  const auto plant = kind_of(loop.plant);
  const bool mechanical = loop.friction || plant == "mass" || plant == "belt" || plant == "two-mass";
  return mechanical ? Units{} : Units{"", ""};
}

}  // namespace limcycle
