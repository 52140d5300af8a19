#include <cmath>

#include "limcycle/models/diagram/assemble.hpp"
#include "limcycle/models/diagram/expand.hpp"
#include "limcycle/models/element/saturation.hpp"

namespace limcycle {
namespace {

SignalSum scaled(SignalSum sum, double factor) {
  for (Term& term : sum) term.factor *= factor;
  return sum;
}

void add(SignalSum& sum, const SignalSum& other) { sum.insert(sum.end(), other.begin(), other.end()); }

/// The blocks of a cascade that reads the error `e` and the velocity of the plant; returns its command.
SignalSum through_cascade(std::vector<Block>& blocks, const Cascade& cascade, SignalSum e) {
  const std::string path = "loop.controller";
  Pid position;
  position.kp = cascade.position_kp;
  position.ki = cascade.position_ki;
  blocks.push_back({"position", path, Controller(position), {std::move(e)}});
  SignalSum error{{1.0, "position", ""}, {-1.0, "plant", "v"}};
  if (cascade.velocity_feedforward != 0.0) error.push_back({cascade.velocity_feedforward, "r", "rate"});
  SignalSum command = scaled(error, cascade.velocity_kp);
  const bool held_back = cascade.anti_windup.index == Cascade::back_calculation;
  if (cascade.velocity_ki != 0.0) {
    command.push_back({cascade.velocity_ki, "integral", ""});
    blocks.push_back({"integral", path, LinearBlock(Integrator{}), {error}});
    blocks.back().states = {"I_velocity"};
  }
  if (!std::isfinite(cascade.limit)) return command;
  if (held_back) {
    add(blocks.back().inputs.front(), {{1.0 / cascade.velocity_kp, "limited", ""}});
    add(blocks.back().inputs.front(), scaled(command, -1.0 / cascade.velocity_kp));
  }
  Saturation<double> saturation;
  saturation.limit = cascade.limit;
  blocks.push_back({"limited", path + ".limit", Element(saturation), {command}});
  return {{1.0, "limited", ""}};
}

}  // namespace

Diagram short_form(const LoopParts& parts) {
  Diagram diagram;
  diagram.output = {1.0, "plant", "y"};
  diagram.load_on = "plant";
  diagram.prefixed_states = false;
  auto& blocks = diagram.blocks;
  blocks.push_back({"plant", "loop.plant", parts.plant});

  SignalSum signal;  // what has come so far on the way to the plant
  if (uses_error(parts)) {
    signal = {{1.0, "r", ""}, {-1.0, "plant", "y"}};
    if (parts.error) {
      blocks.push_back({"error", "loop.error", *parts.error, {signal}});
      signal = {{1.0, "error", ""}};
    }
    if (const auto* cascade = std::get_if<Cascade>(&parts.controller)) {
      signal = through_cascade(blocks, *cascade, std::move(signal));
    } else {
      blocks.push_back({"controller", "loop.controller", parts.controller, {signal}});
      signal = {{1.0, "controller", ""}};
    }
  }
  signal = through_actuator(blocks, actuator_of(parts.controller), "", "loop.controller", std::move(signal), "plant");
  if (parts.element) {
    blocks.push_back({"element", "loop.element", *parts.element, {signal}});
    signal = {{1.0, "element", ""}};
  }
  blocks.front().inputs = {signal};
  if (parts.friction) blocks.push_back({"friction", "loop.friction", *parts.friction, {}, Contact::opposes, "plant"});
  return diagram;
}

Loop assemble(const LoopParts& parts) {
  return assemble(parts.diagram ? expanded(*parts.diagram) : short_form(parts), parts.reference, parts.load);
}

bool uses_error(const LoopParts& parts) {
  return !parts.friction || parts.element || !std::holds_alternative<NoController>(parts.controller);
}

}  // namespace limcycle
