#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <variant>

#include "limcycle/analysis/motion/error_weights.hpp"
#include "limcycle/analysis/motion/field/affine_flow.hpp"
#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/steppers/controlled_rodas5p.hpp"
#include "limcycle/analysis/motion/steppers/explicit_steppers.hpp"

/// @file
/// The steppers of one march; for the sources of March alone.

namespace limcycle {

/// Matrix exponentials instead of a stepper.
struct ExactStepper {
  AffineFlow flow;
  State tolerance;                ///< permitted error of the cubic through the ends of a step
  double length = 0.0;            ///< of the last step, tried or repeated
  std::optional<int> power = {};  ///< if that was 2^power s
  State rate_at_end = {}, middle = {};
  int at_floor = 0;  ///< successive steps that were too long although the shortest possible

  /// Exponential of the last step, in the modes of the field.
  Eigen::MatrixXd exponential() { return power ? flow.over_power(*power) : flow.over(length); }
};

/// A controlled stepper of Odeint, and a plain one for repeated steps: the former may keep the rate of another point.
template <class Controlled>
struct ExplicitStepper {
  Controlled controlled;
  typename Controlled::stepper_type plain{};
};

/// An explicit step from one switch of a clock to the next: as accurate as an implicit one, at half its cost, where
/// clocks are faster than bristles. Where it is refused, the implicit stepper goes on, ever longer.
struct ClockedDopri5 : ExplicitStepper<ControlledDopri5> {
  static constexpr int shortest_pause = 16, longest_pause = 1024;  ///< steps from one that was refused to the next try

  State rate_at_end{};
  bool in_use = false;  ///< for the present step
  int pause = shortest_pause, left = 0;

  /// True if it is tried for a step; counts those for which it is not.
  bool is_due() { return left == 0 || --left == 0; }
  void refused() {
    in_use = false;
    left = pause;
    pause = std::min(2 * pause, longest_pause);
  }
  void reset() {
    in_use = false;
    pause = shortest_pause;
    left = 0;
  }
};

using AnyStepper =
    std::variant<ControlledRodas5p, ExplicitStepper<ControlledDopri5>, ExplicitStepper<ControlledFehlberg78>,
                 ExplicitStepper<ControlledCashKarp54>, ExactStepper>;

struct March::Stepper {
  Stepper(StepperKind kind, const ErrorWeights& weights, LoopField& field);

  AnyStepper moving;
  std::optional<AnyStepper> waiting;  ///< see wait_patiently()
  bool waits = false;
  std::optional<ClockedDopri5> clocked;  ///< of a stiff loop with clocks

  AnyStepper& any() { return waits ? *waiting : moving; }
  bool uses_clocked() const { return clocked && clocked->in_use; }
  /// Discards what the steppers keep of earlier steps.
  void restart();
};

}  // namespace limcycle
