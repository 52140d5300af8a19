#include "limcycle/questions/asking/units_of.hpp"

#include <string>
#include <variant>

namespace limcycle {

namespace {

PlantSignals signals_of(const Plant& plant) {
  return std::visit([]<class Kind>(const Kind&) { return Kind::signals; }, plant);
}

/// Unit of the plant's input where it is none of force: the current of a drive.
std::string input_unit_of(const Plant& plant, const std::string& force) {
  return std::visit(
      [&]<class Kind>(const Kind&) -> std::string {
        if constexpr (requires { Kind::input_unit; })
          return std::string(Kind::input_unit);
        else
          return force;
      },
      plant);
}

/// A diagram is mechanical if it has friction on a body, or a plant of masses.
Units units_of_diagram(const Diagram& diagram) {
  for (const Block& block : diagram.blocks) {
    const auto* plant = std::get_if<Plant>(&block.what);
    if (plant != nullptr && signals_of(*plant) == PlantSignals::angles_and_torques) return {"rad", "N m", "rad"};
    const bool masses = plant != nullptr && signals_of(*plant) == PlantSignals::lengths_and_forces;
    if (masses || block.contact == Contact::opposes) return {};
  }
  return {"", "", ""};
}

Units units_of_loop(const LoopParts& loop) {
  if (loop.diagram) return units_of_diagram(*loop.diagram);
  const PlantSignals signals = signals_of(loop.plant);
  if (signals == PlantSignals::angles_and_torques)
    return {"rad", loop.friction ? "N" : "N m", loop.friction ? "m" : "rad", "N m"};
  if (const auto* named = std::get_if<StateSpacePlant>(&loop.plant); named != nullptr && loop.friction) {
    const PlantModel model = named->model();
    if (model.C_x != model.C_y) return {"", "N", "m"};  // the output is not the rubbing displacement: a flow, an angle
  }
  if (!loop.friction && signals == PlantSignals::unknown) return {"", "", ""};
  Units units;
  units.command = input_unit_of(loop.plant, units.force);
  return units;
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
