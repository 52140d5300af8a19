#include "limcycle/models/linear/controllers.hpp"

#include <cmath>

namespace limcycle {
namespace {

StateSpace sized(Eigen::Index n) {
  return {Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, 1), Eigen::MatrixXd::Zero(1, n),
          Eigen::MatrixXd::Zero(1, 1)};
}

std::vector<std::string> numbered(Eigen::Index n) {
  std::vector<std::string> names;
  for (Eigen::Index i = 0; i < n; ++i) names.push_back("c" + std::to_string(i + 1));
  return names;
}

constexpr double widest_window = 100.0;   ///< samples: the past inputs are states
constexpr double latest_command = 100.0;  ///< samples: the commands that wait are states
constexpr double slowest_position = 1e6;

}  // namespace

std::optional<BrokenRule> Sampling::broken_together() const {
  if (!is_on()) {
    for (const auto& [key, value] : {std::pair("computation_delay", computation_delay),
                                     {"input_step", input_step},
                                     {"output_step", output_step},
                                     {"velocity_window", velocity_window}})
      if (value > 0.0) return BrokenRule{key, "needs sample_time: a continuous controller has none"};
    return std::nullopt;
  }
  if (computation_delay > latest_command * sample_time)
    return BrokenRule{"computation_delay", "must be at most 100 times sample_time"};
  if (velocity_window != std::floor(velocity_window) || velocity_window > widest_window)
    return BrokenRule{"velocity_window", "must be a whole number of samples, at most 100"};
  return std::nullopt;
}

ControllerModel NoController::model() const {
  ControllerModel controller{sized(0), 0.0, {}};
  controller.ss.D(0, 0) = 1.0;
  return controller;
}

std::string_view Pid::held_back_by() const {
  if (integral_limit < infinite) return "integral_limit";
  if (integral_band < infinite) return "integral_band";
  if (integral_dead_zone > 0.0) return "integral_dead_zone";
  return integral_reset > 0.0 ? "integral_reset" : "";
}

std::optional<BrokenRule> Pid::broken_impulses() const {
  for (const auto& [key, value] : {std::pair("impulse_width", impulse_width),
                                   {"impulse_pause", impulse_pause},
                                   {"impulse_band", impulse_band},
                                   {"impulse_speed", impulse_speed}}) {
    if (value > 0.0 && impulse == 0.0) return BrokenRule{key, "needs impulse: there are none"};
    if (value == 0.0 && impulse > 0.0) return BrokenRule{"impulse", std::string("needs ") + key};
  }
  if (impulse > 0.0 && is_on()) return BrokenRule{"impulse", "is not for a sampled controller yet"};
  return std::nullopt;
}

std::optional<BrokenRule> Pid::broken_together() const {
  if (reset_interval > 0.0 && integral_reset == 0.0)
    return BrokenRule{"reset_interval", "needs integral_reset: there is no reset"};
  if (reset_speed > 0.0 && integral_reset == 0.0)
    return BrokenRule{"reset_speed", "needs integral_reset: there is no reset"};
  if (reset_speed > 0.0 && reset_interval > 0.0)
    return BrokenRule{"reset_interval", "is for resets where e changes sign, not beside reset_speed"};
  if (integral_hysteresis > 0.0 && integral_dead_zone == 0.0)
    return BrokenRule{"integral_hysteresis", "needs integral_dead_zone: there is none"};
  if (auto broken = broken_impulses()) return broken;
  const std::string key(held_back_by());
  if (key.empty()) return std::nullopt;
  for (const auto& [other, is_there] : {std::pair("integral_band", integral_band < infinite),
                                        {"integral_dead_zone", integral_dead_zone > 0.0},
                                        {"integral_reset", integral_reset > 0.0}})
    if (is_there && key != other) return BrokenRule{other, "cannot stand beside " + key};
  if (ki == 0.0) return BrokenRule{key, "needs ki: there is no integral"};
  if (integral_limit < infinite && leak > 0.0)
    return BrokenRule{key, "cannot stand beside leak, which bounds the integral too"};
  if (integral_reset > 0.0 && leak > 0.0) return BrokenRule{key, "cannot stand beside leak yet"};
  if (is_on()) return BrokenRule{key, "is not for a sampled controller yet"};
  return std::nullopt;
}

ControllerModel Pid::model() const {
  const bool integral = ki != 0.0, filtered = kd != 0.0 && tf > 0.0;
  const Eigen::Index n = (integral ? 1 : 0) + (filtered ? 1 : 0);
  ControllerModel controller{sized(n), kd != 0.0 && !filtered ? kd : 0.0, {}};
  auto& [A, B, C, D] = controller.ss;
  D(0, 0) = kp;
  if (integral) {  // state: integral of e, what has leaked out taken off
    A(0, 0) = -leak;
    B(0, 0) = 1.0;
    C(0, 0) = ki;
    controller.state_names.emplace_back("I");
  }
  if (filtered) {  // kd s/(tf s + 1) = kd/tf - (kd/tf)/(tf s + 1); state: filtered e
    const Eigen::Index i = n - 1;
    A(i, i) = -1.0 / tf;
    B(i, 0) = 1.0 / tf;
    C(0, i) = -kd / tf;
    D(0, 0) += kd / tf;
    controller.state_names.emplace_back("e_filtered");
  }
  return controller;
}

std::optional<BrokenRule> Cascade::broken_together() const {
  if (position_every != std::floor(position_every) || position_every > slowest_position)
    return BrokenRule{"position_every", "must be a whole number of samples, at most 1000000"};
  if (position_every > 1.0 && !is_on()) return BrokenRule{"position_every", "needs sample_time"};
  if (anti_windup.index == 0) return std::nullopt;
  if (!std::isfinite(limit)) return BrokenRule{"anti_windup", "needs a limit"};
  if (velocity_ki == 0.0) return BrokenRule{"anti_windup", "needs velocity_ki: there is no integral to hold back"};
  if (!(velocity_kp > 0.0)) return BrokenRule{"anti_windup", "needs velocity_kp > 0"};
  return std::nullopt;
}

ControllerModel Cascade::model() const {
  Pid position;
  position.kp = position_kp;
  position.ki = position_ki;
  return position.model();
}

std::optional<BrokenRule> TransferFunctionController::validate() const {
  try {
    if (numerator.empty()) return BrokenRule{"numerator", "must not be empty"};
    realise(numerator, denominator);
  } catch (const std::invalid_argument& error) {
    return BrokenRule{denominator.empty() ? "denominator" : "numerator", error.what()};
  }
  return std::nullopt;
}

ControllerModel TransferFunctionController::model() const {
  StateSpace g = realise(numerator, denominator);
  auto names = numbered(g.states());
  return {std::move(g), 0.0, std::move(names)};
}

std::optional<BrokenRule> StateSpaceController::validate() const {
  const auto n = A.rows();
  if (A.cols() != n) return BrokenRule{"A", "must be square"};
  if (B.rows() != n || B.cols() != 1) return BrokenRule{"B", "must be one column with as many rows as A"};
  if (C.cols() != n || C.rows() != 1) return BrokenRule{"C", "must be one row with as many columns as A"};
  if (D.size() > 1) return BrokenRule{"D", "must be a single number [[d]]"};
  return std::nullopt;
}

ControllerModel StateSpaceController::model() const {
  return {{A, B, C, D.size() == 1 ? D : Eigen::MatrixXd(Eigen::MatrixXd::Zero(1, 1))}, 0.0, numbered(A.rows())};
}

}  // namespace limcycle
