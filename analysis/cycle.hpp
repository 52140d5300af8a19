#pragma once
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Continuous state of a loop (linear states, then the states of its elements in order) with the modes of the elements.
struct LoopState {
  std::vector<double> x;
  std::vector<Mode> modes;
};

/// Observable course of a run, for tables and figures. Columns are of equal length.
struct Trace {
  std::vector<double> t;         ///< s
  std::vector<double> y;         ///< measured output, from y_origin
  std::vector<double> rate;      ///< dy/dt
  std::vector<double> input;     ///< input of the element of interest (the friction if there is one, else the last)
  std::vector<double> velocity;  ///< rate of that input
  std::vector<double> output;    ///< output of that element (friction force, N)
  double y_origin = 0.0;         ///< see Loop::output_origin; `input` of a friction law begins there too
};

/// A periodic motion of a loop.
struct Cycle {
  double amplitude = 0.0;                         ///< half the peak-to-peak of y
  double first_harmonic = 0.0;                    ///< amplitude of y's first harmonic
  double period = 0.0;                            ///< s
  double offset = 0.0;                            ///< mean of y
  std::optional<bool> stable;                     ///< empty: could not be decided
  std::vector<std::complex<double>> multipliers;  ///< Floquet, of the full period, without the trivial 1, largest first
  /// Estimated absolute error of each multiplier; above 0.5 if they could not be determined, and none are given.
  double multiplier_error = 0.0;
  /// Numbers in which the loop keeps part of its history (return points of an outer hysteresis loop, the integral of a
  /// sampled controller of a relay) and which the motion neither changes nor forgets: another history gives another
  /// cycle, close to this one. Their multipliers, all 1, are not among those above, and `stable` is for a given
  /// history.
  int remembered = 0;
  double sticking_fraction = 0.0;  ///< share of the period that is stuck
  std::string method;              ///< "shooting" or "exact"
  double error = 0.0;              ///< estimated relative error of period and amplitude
  double residual = 0.0;           ///< scaled |x(T) - x(0)| of the answer
  bool half_wave_symmetric = false;
  LoopState start;  ///< a point of the cycle
  Trace trace;      ///< one period

  double frequency() const { return 6.283185307179586476925 / period; }  ///< rad/s
};

}  // namespace limcycle
