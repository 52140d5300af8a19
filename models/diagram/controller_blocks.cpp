#include "limcycle/models/diagram/controller_blocks.hpp"

#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/memoryless/window.hpp"
#include "limcycle/models/element/of_controllers/clamped_pi.hpp"
#include "limcycle/models/element/of_controllers/impulses.hpp"
#include "limcycle/models/element/of_controllers/reset_integrator.hpp"
#include "limcycle/models/element/of_controllers/sampled.hpp"
#include "limcycle/models/element/of_controllers/stop_reset_integrator.hpp"
#include "limcycle/models/element/with_memory/hysteretic_dead_zone.hpp"
#include "limcycle/models/linear/discrete.hpp"

namespace limcycle {
namespace {

/// The integral of a PID as one element; empty for one with a band or a dead zone.
std::optional<Element> held_integral(const Pid& pid) {
  if (pid.integral_limit < infinite) {
    ClampedPi<double> integral;
    integral.ki = pid.ki;
    integral.limit = pid.integral_limit;
    return integral;
  }
  if (pid.integral_reset > 0.0 && pid.reset_speed > 0.0) {
    StopResetIntegrator<double> integral;
    integral.gain = pid.ki;
    integral.share = pid.integral_reset;
    integral.speed = pid.reset_speed;
    return integral;
  }
  if (pid.integral_reset > 0.0) {
    ResetIntegrator<double> integral;
    integral.gain = pid.ki;
    integral.share = pid.integral_reset;
    integral.interval = pid.reset_interval;
    return integral;
  }
  return std::nullopt;
}

/// What lets the error through to the integral.
Element before_integral(const Pid& pid) {
  if (pid.integral_band < infinite) {
    Window<double> window;
    window.half_width = pid.integral_band;
    return window;
  }
  if (pid.integral_hysteresis > 0.0) {
    HystereticDeadZone<double> zone;
    zone.half_width = pid.integral_dead_zone;
    zone.hysteresis = pid.integral_hysteresis;
    return zone;
  }
  DeadZone<double> zone;
  zone.half_width = pid.integral_dead_zone;
  return zone;
}

/// The integral of a PID as blocks of its own, behind the rest of it.
SignalSum through_held_integral(std::vector<Block>& blocks, const Pid& pid, SignalSum e) {
  const std::string path = "loop.controller";
  Pid rest = pid;
  rest.ki = 0.0;
  blocks.push_back({"controller", path, Controller(rest), {e}});
  if (const auto integral = held_integral(pid)) {
    blocks.push_back({"integral", path + "." + std::string(pid.held_back_by()), *integral, {std::move(e)}});
    return {{1.0, "controller", ""}, {1.0, "integral", ""}};
  }
  const std::string key(pid.held_back_by());
  blocks.push_back({key, path + "." + key, before_integral(pid), {std::move(e)}});
  blocks.push_back({"integral", path, LinearBlock(Integrator{1.0, pid.leak}), {{{1.0, key, ""}}}});
  blocks.back().states = {"I"};
  return {{1.0, "controller", ""}, {pid.ki, "integral", ""}};
}

}  // namespace

void add_impulses(std::vector<Block>& blocks, const Controller& controller, SignalSum error, SignalSum& command) {
  const auto* pid = std::get_if<Pid>(&controller);
  if (pid == nullptr || pid->impulse == 0.0) return;
  Impulses<double> impulses;
  impulses.force = pid->impulse;
  impulses.width = pid->impulse_width;
  impulses.pause = pid->impulse_pause;
  impulses.band = pid->impulse_band;
  impulses.speed = pid->impulse_speed;
  blocks.push_back({"impulses", "loop.controller.impulse", Element(impulses), {std::move(error)}});
  command.push_back({1.0, "impulses", ""});
}

StateSpace discrete_of(const Controller& controller, const Sampling& sampling) {
  const auto* pid = std::get_if<Pid>(&controller);
  if (pid != nullptr && sampling.velocity_window > 0.0)
    return windowed_difference(*pid, sampling.sample_time, static_cast<int>(sampling.velocity_window));
  return backward_difference(model_of(controller), sampling.sample_time);
}

ControllerModel model_behind_window(const Controller& controller, const Sampling& sampling) {
  if (const auto* pid = std::get_if<Pid>(&controller); pid != nullptr && sampling.velocity_window > 1.0) {
    Pid slower = *pid;
    slower.tf += 0.5 * (sampling.velocity_window - 1.0) * sampling.sample_time;
    return slower.model();
  }
  return model_of(controller);
}

Element encoder(const Sampling& sampling, double every) {
  Sampled<double> element;
  element.sample_time = sampling.sample_time;
  element.input_quantum = sampling.input_step;
  element.every = every;
  element.D = 1.0;
  return element;
}

Sampled<double> on_computer(const Sampling& sampling, const StateSpace& discrete, Eigen::Index of_states) {
  Sampled<double> element;
  element.sample_time = sampling.sample_time;
  for (const auto row : discrete.A.rowwise()) element.A.insert(element.A.end(), row.begin(), row.end());
  element.B.assign(discrete.B.col(0).begin(), discrete.B.col(0).end());
  element.C.assign(discrete.C.row(0).begin(), discrete.C.row(0).end());
  element.D = discrete.D(0, 0);
  element.memory = static_cast<double>(discrete.states() - of_states);
  return element;
}

Block averaged_block(std::string name, std::string path, ControllerModel model, double sample_time, SignalSum e) {
  const StateSpace mean = averaged(model, sample_time);
  StateSpaceController controller;
  controller.A = mean.A;
  controller.B = mean.B;
  controller.C = mean.C;
  controller.D = mean.D;
  Block block{std::move(name), std::move(path), Controller(std::move(controller)), {std::move(e)}};
  block.states = std::move(model.state_names);
  if (std::ssize(block.states) < mean.states()) block.states.emplace_back("e_last");
  return block;
}

SignalSum through_controller(std::vector<Block>& blocks, const Controller& controller, SignalSum e, Clock clock) {
  if (const auto* cascade = std::get_if<Cascade>(&controller))
    return through_cascade(blocks, *cascade, std::move(e), clock);
  if (const auto* pid = std::get_if<Pid>(&controller); pid != nullptr && pid->holds_integral_back())
    return through_held_integral(blocks, *pid, std::move(e));
  const std::string name = "controller", path = "loop.controller";
  const Sampling& sampling = sampling_of(controller);
  switch (clock) {
    case Clock::continuous:
      blocks.push_back({name, path, controller, {std::move(e)}});
      break;
    case Clock::averaged:
      blocks.push_back(
          averaged_block(name, path, model_behind_window(controller, sampling), sampling.sample_time, std::move(e)));
      break;
    case Clock::sampled: {
      Sampled<double> element =
          on_computer(sampling, discrete_of(controller, sampling), model_of(controller).ss.states());
      element.computation_delay = sampling.computation_delay;
      element.output_quantum = sampling.output_step;
      blocks.push_back({name, path, Element(element), {std::move(e)}});
    }
  }
  return {{1.0, name, ""}};
}

}  // namespace limcycle
