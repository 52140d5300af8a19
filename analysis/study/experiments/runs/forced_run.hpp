#pragma once
#include <functional>
#include <string>
#include <vector>

#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// A mass that rubs under a prescribed force: m dv/dt = u(t) - F, from rest.
struct ForcedRun {
  std::vector<double> t, x, v, F, u;  ///< at the end of every step; a jump of F gives two samples at one time
  Status status = Status::converged;
  long steps = 0;

  /// Index of the last sample at or before time t.
  std::size_t at(double time) const;
  /// Displacement at time t, between samples by a cubic through positions and velocities.
  double displacement(double time) const;
  /// Time at which x first reaches a position; NaN if never.
  double time_of(double position) const;
  /// Mean displacement between two times with the weight 1 - cos over them, which hides ringing.
  double mean_displacement(double from, double to) const;
};

struct ForcedOptions {
  double mass = 1.0;      ///< kg
  double duration = 0.0;  ///< s
  double rtol = 1e-7;
  double longest_step = infinite;        ///< s; measurements between samples need a limit
  double until_displacement = infinite;  ///< ends the run where x reaches this, m
  std::vector<double> samples{};         ///< times at which a step must end, s
  std::function<bool()> stop;
};

ForcedRun run_forced(const Element& law, const Signal& force, const ForcedOptions& options);

/// A law under prescribed motion from rest: dv/dt = acceleration(t) for any force. `u` is the acceleration; `stepper`
/// as in SimulateOptions.
ForcedRun run_accelerated(const Element& law, const Signal& acceleration, const ForcedOptions& options,
                          const std::string& stepper = "auto");

/// Piecewise linear signal through these points.
Signal signal_through(std::vector<double> times, std::vector<double> values);

/// A peak of sampled values: of the parabola through the largest one up to index `end` and its neighbours.
struct Peak {
  std::size_t index = 0;
  double value = 0.0;
};
Peak peak_of(const std::vector<double>& t, const std::vector<double>& values, std::size_t end);

/// Area under y over x by the trapezoidal rule, from sample `from` to `to`.
double area(const std::vector<double>& x, const std::vector<double>& y, std::size_t from, std::size_t to);

}  // namespace limcycle
