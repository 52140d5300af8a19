#pragma once
#include <functional>
#include <span>
#include <vector>

#include "limcycle/analysis/energy/passivity/passivity.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// Accuracy and limits of the independent check.
struct ReferenceMarchOptions {
  double tolerance = 1e-12;     ///< of one step, relative to the state and its scale
  long max_steps = 20'000'000;  ///< of the whole run
  std::function<bool()> stop;
  /// Called at the beginning of every piece of the input and after every step.
  std::function<void(const Input<double>&, Mode, std::span<const double>)> watch;
};

/// A law driven through a number of periods of an input.
struct ReferenceMarch {
  Status status = Status::converged;
  std::vector<double> z;      ///< state at the end
  Mode mode{};                ///< mode at the end
  std::vector<double> taken;  ///< energy taken out since the beginning, -int F v dt, after each whole period, J
  double supplied = 0.0;      ///< +int F v dt until the end, J
  long steps = 0;
};

/// Drives the law from the state z and mode through `cycles` periods of the input, x being 0 at the beginning.
///
/// It shares with the methods that it checks only the law's own rate, output, guards and next mode: Boost.Odeint's
/// controlled Runge-Kutta-Fehlberg 7(8), the energy being one more state; the pieces of the input are integrated
/// separately and split where v = 0; a switch is located by bisection of the step in which its guard turns negative. An
/// explicit method: it costs steps in proportion to the fastest rate of the law times the period.
///
/// Status: max_iterations (step limit reached), stalled (a step underflows), chattering (switches without end at one
/// time), not_finite, interrupted. Throws std::invalid_argument for an input without a positive period or a state of
/// another size.
ReferenceMarch reference_march(const Element& law, const VelocityCycle& input, std::vector<double> z, Mode mode,
                               int cycles, const ReferenceMarchOptions& options = {});

/// The same from a law without history.
ReferenceMarch reference_march_virgin(const Element& law, const VelocityCycle& input, int cycles,
                                      const ReferenceMarchOptions& options = {});

}  // namespace limcycle
