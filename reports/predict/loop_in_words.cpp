#include <fmt/format.h>

#include <cmath>

#include "limcycle/models/diagram/assemble.hpp"
#include "limcycle/reports/figures/blocks/block_diagram.hpp"
#include "limcycle/reports/figures/blocks/block_words.hpp"
#include "limcycle/reports/figures/staircase.hpp"

namespace limcycle {

/// Rubbing velocity of the law, as the plant defines it.
std::string rubbing_velocity(const Plant& plant) {
  if (const auto* belt = std::get_if<Belt>(&plant)) return "v = dy/dt \xE2\x88\x92 " + diagram_number(belt->speed);
  if (const auto* shaft = std::get_if<FroudePendulum>(&plant))
    return fmt::format("v = {} (dy/dt \xE2\x88\x92 {})", diagram_number(shaft->shaft_radius),
                       diagram_number(shaft->shaft_speed));
  if (const auto* pair = std::get_if<TwoMass>(&plant))
    return "v of the " + std::string(TwoMass::sides[static_cast<std::size_t>(pair->friction_on.index)]);
  const PlantModel model = model_of(plant);
  return model.C_x == model.C_y ? "v = dy/dt" : "v";
}

std::string reference_words(const LoopParts& parts, const Units& units) {
  if (parts.reference_rate == 0.0)
    return "r = " + Units::attach(diagram_number(parts.reference * units.y_per_si), units.y);
  const std::string rate = units.y.empty() ? "1/s" : units.y + "/s";
  return fmt::format("r = t \xC3\x97 {} {}", diagram_number(parts.reference_rate * units.y_per_si), rate);
}

std::string load_words(const LoopParts& parts, const Units& units) {
  return "load = " + Units::attach(diagram_number(parts.load), units.command);
}

namespace {

/// "the error of r = 0 m goes through ..., ... to the plant".
std::string command_in_words(const LoopParts& parts, const Units& units) {
  const Actuator& actuator = actuator_of(parts.controller);
  if (!uses_error(parts) && actuator.friction_compensation == 0.0) return "No controller acts on ";
  std::vector<std::string> stages;
  if (uses_error(parts)) {
    if (parts.error) stages.push_back(element_words("", *parts.error, units).whole + " on the error");
    if (const auto controller = controller_words(parts.controller, units))
      stages.push_back("the controller " + controller->whole);
  }
  if (actuator.friction_compensation > 0.0)
    stages.push_back(compensation_words(actuator.friction_compensation, units).whole + ", added");
  if (std::isfinite(actuator.saturation)) stages.push_back(limit_words(actuator.saturation, units).whole);
  if (actuator.lag > 0.0) stages.push_back(lag_words(actuator.lag).whole);
  if (parts.element) stages.push_back("the element " + element_words("", *parts.element, units).whole);
  const std::string begin = uses_error(parts)
                                ? "The error, " + reference_words(parts, units) + " less the measured y, goes "
                                : "A command goes ";
  return begin +
         (stages.empty() ? std::string("straight to ") : fmt::format("through {} to ", fmt::join(stages, ", ")));
}

std::string diagram_in_words(const LoopParts& parts, const Units& units) {
  std::string words = "The reference is " + reference_words(parts, units) + ".";
  for (const Block& block : parts.diagram->blocks) {
    words += " " + block.name + ", " + words_of_block(block, units).whole;
    if (!block.inputs.empty()) {
      std::vector<std::string> inputs;
      for (const SignalSum& sum : block.inputs) inputs.push_back(sum_in_words(sum));
      words += fmt::format(", reads {}.", fmt::join(inputs, " and "));
    } else if (block.contact != Contact::none) {
      words += (block.contact == Contact::opposes ? ", opposes the velocity of " : ", follows the velocity of ") +
               block.on + (block.against.empty() ? "." : " relative to " + block.against + ".");
    } else {
      words += ", has no input.";
    }
  }
  const Term& y = parts.diagram->output;
  return words + " The output y is " + sum_in_words({y}) + ".";
}

}  // namespace

std::string loop_in_words(const LoopParts& parts, const Units& units) {
  if (parts.diagram) return diagram_in_words(parts, units);
  const BlockWords plant = plant_words(parts.plant, units);
  std::string words = command_in_words(parts, units) + "the plant " + plant.whole + ".";
  if (parts.load != 0.0) words += " A constant " + load_words(parts, units) + " acts on the plant.";
  if (parts.friction)
    words += " Friction, " + element_words("", *parts.friction, units).whole + ", opposes the rubbing velocity " +
             rubbing_velocity(parts.plant) + ".";
  return words;
}

}  // namespace limcycle
