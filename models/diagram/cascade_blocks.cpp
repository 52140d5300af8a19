#include <cmath>

#include "limcycle/models/diagram/controller_blocks.hpp"
#include "limcycle/models/element/memoryless/saturation.hpp"
#include "limcycle/models/element/of_controllers/clamped_pi.hpp"
#include "limcycle/models/element/of_controllers/sampled.hpp"
#include "limcycle/models/linear/discrete.hpp"

namespace limcycle {
namespace {

SignalSum scaled(SignalSum sum, double factor) {
  for (Term& term : sum) term.factor *= factor;
  return sum;
}

void add(SignalSum& sum, const SignalSum& other) { sum.insert(sum.end(), other.begin(), other.end()); }

bool holds_back(const Cascade& cascade) { return cascade.anti_windup.index == Cascade::back_calculation; }
bool clamps(const Cascade& cascade) { return cascade.anti_windup.index == Cascade::clamp; }

SignalSum velocity_error(const Cascade& cascade, Term position, Term velocity) {
  velocity.factor = -1.0;
  SignalSum error{std::move(position), std::move(velocity)};
  if (cascade.velocity_feedforward != 0.0) error.push_back({cascade.velocity_feedforward, "r", "rate"});
  return error;
}

/// The position loop and the velocity, as the velocity loop sees them: its error.
SignalSum continuous_error(std::vector<Block>& blocks, const Cascade& cascade, SignalSum e) {
  Pid position;
  position.kp = cascade.position_kp;
  position.ki = cascade.position_ki;
  blocks.push_back({"position", "loop.controller", Controller(position), {std::move(e)}});
  return velocity_error(cascade, {1.0, "position", ""}, {1.0, "plant", "v"});
}

/// On average: the command of a slower position loop is half the difference of the two ticks old; a velocity over n
/// samples half of these.
SignalSum averaged_error(std::vector<Block>& blocks, const Cascade& cascade, SignalSum e) {
  const double tick = cascade.sample_time, position_tick = tick * cascade.position_every;
  blocks.push_back(averaged_block("position", "loop.controller", cascade.model(), position_tick, std::move(e)));
  const auto late = [&](const Term& term, const std::string& name, double time) -> Term {
    if (!(time > 0.0)) return term;
    blocks.push_back({name, "loop.controller", LinearBlock(LowPass{.time_constant = time}), {{term}}});
    blocks.back().states = {name};
    return {1.0, name, ""};
  };
  return velocity_error(cascade, late({1.0, "position", ""}, "held_position", 0.5 * (position_tick - tick)),
                        late({1.0, "plant", "v"}, "late_velocity", 0.5 * cascade.velocity_window * tick));
}

SignalSum sampled_error(std::vector<Block>& blocks, const Cascade& cascade, SignalSum e) {
  const std::string path = "loop.controller";
  const ControllerModel model = cascade.model();
  Sampled<double> position =
      on_computer(cascade, backward_difference(model, cascade.sample_time * cascade.position_every), model.ss.states());
  position.every = cascade.position_every;
  blocks.push_back({"position", path + ".position", Element(position), {std::move(e)}});
  Term v{1.0, "plant", "v"};
  if (cascade.velocity_window > 0.0) {
    Sampled<double> velocity =
        on_computer(cascade, difference_over(static_cast<int>(cascade.velocity_window), cascade.sample_time), 0);
    velocity.input_quantum = cascade.input_step;
    blocks.push_back({"velocity", path + ".velocity", Element(velocity), {{{1.0, "plant", "y"}}}});
    v = {1.0, "velocity", ""};
  }
  return velocity_error(cascade, {1.0, "position", ""}, v);
}

/// The velocity loop as a continuous one, its integral clamped, or held back by what the limit takes off.
SignalSum velocity_loop(std::vector<Block>& blocks, const Cascade& cascade, const SignalSum& error, double kp) {
  const std::string path = "loop.controller";
  if (clamps(cascade)) {
    ClampedPi<double> pi;
    pi.kp = kp;
    pi.ki = cascade.velocity_ki;
    pi.limit = cascade.limit;
    blocks.push_back({"limited", path + ".limit", Element(pi), {error}});
    return {{1.0, "limited", ""}};
  }
  SignalSum command = scaled(error, kp);
  if (cascade.velocity_ki != 0.0) {
    command.push_back({cascade.velocity_ki, "integral", ""});
    blocks.push_back({"integral", path, LinearBlock(Integrator{}), {error}});
    blocks.back().states = {"I_velocity"};
  }
  if (!std::isfinite(cascade.limit)) return command;
  if (holds_back(cascade)) {
    add(blocks.back().inputs.front(), {{1.0 / cascade.velocity_kp, "limited", ""}});
    add(blocks.back().inputs.front(), scaled(command, -1.0 / cascade.velocity_kp));
  }
  Saturation<double> saturation;
  saturation.limit = cascade.limit;
  blocks.push_back({"limited", path + ".limit", Element(saturation), {command}});
  return {{1.0, "limited", ""}};
}

/// The same on a computer.
SignalSum sampled_velocity_loop(std::vector<Block>& blocks, const Cascade& cascade, SignalSum error) {
  Pid pi;
  pi.kp = cascade.velocity_kp;
  pi.ki = cascade.velocity_ki;
  const ControllerModel model = pi.model();
  Sampled<double> element = on_computer(cascade, backward_difference(model, cascade.sample_time), model.ss.states());
  element.computation_delay = cascade.computation_delay;
  element.output_quantum = cascade.output_step;
  element.limit = cascade.limit;
  if (holds_back(cascade)) element.hold_back = {cascade.sample_time / cascade.velocity_kp};
  if (clamps(cascade)) element.clamped = 1.0;
  blocks.push_back({"controller", "loop.controller", Element(element), {std::move(error)}});
  return {{1.0, "controller", ""}};
}

}  // namespace

SignalSum through_cascade(std::vector<Block>& blocks, const Cascade& cascade, SignalSum e, Clock clock) {
  switch (clock) {
    case Clock::sampled:
      return sampled_velocity_loop(blocks, cascade, sampled_error(blocks, cascade, std::move(e)));
    case Clock::averaged:  // a sum of samples is an integral and half a sample
      return velocity_loop(blocks, cascade, averaged_error(blocks, cascade, std::move(e)),
                           cascade.velocity_kp + 0.5 * cascade.sample_time * cascade.velocity_ki);
    case Clock::continuous:
      break;
  }
  return velocity_loop(blocks, cascade, continuous_error(blocks, cascade, std::move(e)), cascade.velocity_kp);
}

}  // namespace limcycle
