#pragma once
#include <complex>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// The control loop without its friction, opened at the command: L(s) = C(s) P(s) exp(-s delay), and the part of it
/// from the measured y to the command, C(s). Dead zones and saturations count with their slope of 1, a sampled
/// controller as the continuous one with the mean dead time of hold and computation, a cascade with its velocity loop
/// on the measured velocity: C = (velocity_kp + velocity_ki/s) (position_kp + position_ki/s + s).
struct OpenLoop {
  std::function<std::complex<double>(std::complex<double>)> L, C;
  bool unlimited_gain = false;  ///< C(jw) grows without bound: a derivative without a filter
  double highest = std::numeric_limits<double>::infinity();  ///< rad/s, of what a sampled controller can see
};

/// Of the five slots of a case with a controller. Empty, with the reason in `why`: a diagram, no controller, a
/// pendulum, or an element whose slope is not 1, such as a relay.
std::optional<OpenLoop> open_loop(const LoopParts& parts, std::string& why);

/// The highest frequency at which |L(jw)| = 1, rad/s, to rounding. Empty if there is none between 1e-9 and 1e9 rad/s.
std::optional<double> highest_crossover(const LoopParts& parts);

/// Robustness of the linear loop, as it is without friction.
struct LinearCosts {
  bool stable = false;  ///< all poles of the closed loop have negative real parts; else none of the others is given
  std::string why_not;  ///< reason why there is no such loop, a clause; empty: there is
  std::optional<double> phase_margin;      ///< rad, the least |arg L + pi| over all w with |L(jw)| = 1
  std::optional<double> delay_margin;      ///< s, the least additional dead time at which the loop is unstable
  std::optional<double> peak_sensitivity;  ///< Ms, the largest |1/(1 + L(jw))|
  std::optional<double> noise_gain;        ///< the largest |C/(1 + L)|, from noise of y to the command; may be infinite
  std::optional<double> settling_time;     ///< s, of a step of the reference to within 2 % of it
  std::optional<double> overshoot;         ///< share of that step
};

/// On a grid of 200 frequencies a decade over the poles of the loop, crossings by bisection and peaks by golden section
/// to 1e-9; the step by the matrix exponential. `step`: its height, which does not matter; 0: no step, whose costs are
/// left empty. Cost: some thousand evaluations of L, O(n^3) each.
LinearCosts linear_costs(const LoopParts& parts, double step);

/// Settling and overshoot of a run of y that begins `step` away from zero and ends at its last value: the last time at
/// which y differs from that by more than 2 % of the step, since the first sample, and the farthest it goes beyond
/// zero, as a share of the step. Between two samples y is the cubic with their values and rates.
struct StepNumbers {
  double settling_time = 0.0, overshoot = 0.0;
};
StepNumbers step_numbers(const Trace& run, double step);

}  // namespace limcycle
