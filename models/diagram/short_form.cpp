#include <cmath>

#include "limcycle/models/diagram/assemble.hpp"
#include "limcycle/models/diagram/expand.hpp"
#include "limcycle/models/element/sampled.hpp"
#include "limcycle/models/element/saturation.hpp"
#include "limcycle/models/linear/discrete.hpp"

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

/// A reading of the input on an encoder, held until the next one.
Element encoder(const Sampling& sampling) {
  Sampled<double> element;
  element.sample_time = sampling.sample_time;
  element.input_quantum = sampling.encoder_quantum;
  element.D = 1.0;
  return element;
}

/// Puts the controller in the place of this block that acts on average as it does on a computer.
void average(Block& block, double sample_time) {
  ControllerModel model = model_of(std::get<Controller>(block.what));
  const StateSpace mean = averaged(model, sample_time);
  StateSpaceController controller;
  controller.A = mean.A;
  controller.B = mean.B;
  controller.C = mean.C;
  controller.D = mean.D;
  block.states = std::move(model.state_names);
  if (std::ssize(block.states) < mean.states()) block.states.emplace_back("e_last");
  block.what = Controller(std::move(controller));
}

/// The controller as an element that reads its input at sample instants.
Element on_computer(const Controller& controller) {
  const Sampling& sampling = sampling_of(controller);
  const StateSpace discrete = backward_difference(model_of(controller), sampling.sample_time);
  Sampled<double> element;
  element.sample_time = sampling.sample_time;
  element.computation_delay = sampling.computation_delay;
  element.output_quantum = sampling.output_quantum;
  for (const auto row : discrete.A.rowwise()) element.A.insert(element.A.end(), row.begin(), row.end());
  element.B.assign(discrete.B.col(0).begin(), discrete.B.col(0).end());
  element.C.assign(discrete.C.row(0).begin(), discrete.C.row(0).end());
  element.D = discrete.D(0, 0);
  return element;
}

}  // namespace

Diagram short_form(const LoopParts& parts, Clock clock) {
  const Sampling& sampling = sampling_of(parts.controller);
  const bool sampled = clock == Clock::sampled;
  Diagram diagram;
  diagram.output = {1.0, "plant", "y"};
  diagram.load_on = "plant";
  diagram.prefixed_states = false;
  auto& blocks = diagram.blocks;
  blocks.push_back({"plant", "loop.plant", parts.plant});
  if (clock == Clock::averaged) blocks.back().late = sampling.mean_delay();

  SignalSum signal;  // what has come so far on the way to the plant
  if (uses_error(parts)) {
    signal = {{1.0, "r", ""}, {-1.0, "plant", "y"}};
    if (sampled && sampling.encoder_quantum > 0.0) {
      blocks.push_back({"encoder", "loop.controller.encoder", encoder(sampling), {{{1.0, "plant", "y"}}}});
      signal.back() = {-1.0, "encoder", ""};
    }
    if (parts.error) {
      blocks.push_back({"error", "loop.error", *parts.error, {signal}});
      signal = {{1.0, "error", ""}};
    }
    if (const auto* cascade = std::get_if<Cascade>(&parts.controller)) {
      signal = through_cascade(blocks, *cascade, std::move(signal));
    } else {
      blocks.push_back({"controller", "loop.controller", parts.controller, {signal}});
      if (sampled) blocks.back().what = on_computer(parts.controller);
      if (clock == Clock::averaged) average(blocks.back(), sampling.sample_time);
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
  if (parts.diagram) return assemble(expanded(*parts.diagram), parts.reference, parts.load);
  const auto form = [&](Clock clock) { return assemble(short_form(parts, clock), parts.reference, parts.load); };
  if (!sampling_of(parts.controller).is_on() || !uses_error(parts)) return form(Clock::continuous);
  Loop sampled = form(Clock::sampled), loop = form(Clock::averaged);
  sampled.continuous = std::make_shared<const Loop>(form(Clock::continuous));
  loop.sampled = std::make_shared<const Loop>(std::move(sampled));
  return loop;
}

bool uses_error(const LoopParts& parts) {
  return !parts.friction || parts.element || !std::holds_alternative<NoController>(parts.controller);
}

}  // namespace limcycle
