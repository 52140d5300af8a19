#pragma once
#include <string_view>
#include <vector>

#include "limcycle/analysis/motion/field/loop_field.hpp"

namespace limcycle {

/// Fixed-step methods, as used in many simulations of friction. No result of the program comes from them: the atlas
/// shows the problems that the other methods avoid.
enum class FixedMethod {
  euler,         ///< explicit Euler
  rk4,           ///< the classical method of Runge and Kutta
  semi_implicit  ///< states of the law by linearly implicit Euler, then the others by explicit Euler with the new force
};
std::string_view to_string(FixedMethod method);
/// Evaluations of the right side per step; that of a Jacobian counts as two.
int evaluations_per_step(FixedMethod method);

/// Steps a loop by a fixed method. A switch is not located: a guard found negative at the end of a step fires there.
class FixedStepper {
 public:
  FixedStepper(LoopField& field, FixedMethod method) : field_(field), method_(method) {}

  /// One step of length h from (x, t), whose rate dx is given; x and dx become those at its end.
  void step(State& x, State& dx, double t, double h);

 private:
  void runge_kutta(State& x, double t, double h, const State& dx);
  void semi_implicit(State& x, double t, double h, const State& dx);
  void fire_switches(State& x, double t);

  LoopField& field_;
  FixedMethod method_;
  State stage_, k_, sum_, unused_;
  Eigen::MatrixXd J_;
  std::vector<double> guards_;
};

}  // namespace limcycle
