#include "limcycle/questions/asking/units_of.hpp"

#include <string_view>
#include <variant>

namespace limcycle {

namespace {

/// A diagram is mechanical if it has friction on a body, or a plant of masses.
Units units_of_diagram(const Diagram& diagram) {
  for (const Block& block : diagram.blocks) {
    const auto* plant = std::get_if<Plant>(&block.what);
    if (plant != nullptr && std::holds_alternative<FroudePendulum>(*plant)) return {"rad", "N m", "rad"};
    const bool masses =
        plant != nullptr && (std::holds_alternative<Mass>(*plant) || std::holds_alternative<Belt>(*plant) ||
                             std::holds_alternative<TwoMass>(*plant) || std::holds_alternative<ServoDrive>(*plant));
    if (masses || block.contact == Contact::opposes) return {};
  }
  return {"", "", ""};
}

Units units_of_loop(const LoopParts& loop) {
  if (loop.diagram) return units_of_diagram(*loop.diagram);
  const std::string_view plant = std::visit([]<class Kind>(const Kind&) { return Kind::kind; }, loop.plant);
  if (plant == "froude-pendulum") return {"rad", loop.friction ? "N" : "N m", loop.friction ? "m" : "rad"};
  if (const auto* named = std::get_if<StateSpacePlant>(&loop.plant); named != nullptr && loop.friction) {
    const PlantModel model = named->model();
    if (model.C_x != model.C_y) return {"", "N", "m"};  // the output is not the rubbing displacement: a flow, an angle
  }
  const bool mechanical =
      loop.friction || plant == "mass" || plant == "belt" || plant == "two-mass" || plant == "servo-drive";
  return mechanical ? Units{} : Units{"", "", ""};
}

}  // namespace

Units units_of(const Case& from) {
  Units units = from.loop ? units_of_loop(*from.loop) : Units{};
  if (!from.y_unit || from.y_unit->symbol.empty()) return units;
  units.y = from.y_unit->symbol;
  units.y_per_si = from.y_unit->per_si;
  return units;
}

Units units_of(const Case& from, double swing) {
  Units units = units_of(from);
  const bool asked = from.y_unit && !from.y_unit->symbol.empty();
  if (asked || units.y != "m" || !(swing > 0.0 && swing < 1e-2)) return units;
  const bool tiny = swing < 1e-4;
  units.y = tiny ? "um" : "mm";
  units.y_per_si = tiny ? 1e6 : 1e3;
  return units;
}

}  // namespace limcycle
