#pragma once
#include <algorithm>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/motion/march.hpp"

namespace limcycle {

/// Marches from `from` for the time `duration` and records it; steps are at most duration/`resolution`.
Status record(const Loop& loop, const LoopState& from, double duration, double rtol, int resolution, Trace& trace);

/// Appends one state to a trace. `field` must be in the modes of that state.
void append(Trace& trace, LoopField& field, const State& x, const State& dx, double t);

/// Appends the present state of a march, and the state before a switch.
void append(Trace& trace, LoopField& field, const March& march);

/// Completes the trace of half a period by its reflection at the state `centre`.
void append_reflected(const Loop& loop, const Eigen::VectorXd& centre, Trace& trace);

/// Extremes of y along a march, and their location: the number of the step and the share of it.
struct LocatedExtremes {
  double low = infinite, high = -infinite;
  double low_at = 0.0, high_at = 0.0;
  void include(double y, double at = 0.0);
  /// Includes the last step, number `index`. Within a step they are as accurate as the method: the cubic gives the
  /// location, a step of the method to there gives the value (corrected for the remaining rate). A step that ends with
  /// a switch has the cubic.
  void include(LoopField& field, March& march, std::size_t index);
};
/// Least and greatest of a signal.
struct Extremes {
  double low = 0.0, high = 0.0;
};
/// Extremes of y over a trace, each refined by the cubic through values and rates.
Extremes extremes(const Trace& trace);

/// Harmonics 0..H of the input of the element of interest over one period, b + j a for b sin(n w t) + a cos(n w t), the
/// mean as j times its value.
Eigen::VectorXcd input_harmonics(const Cycle& cycle, int H);
/// The same of y.
Eigen::VectorXcd output_harmonics(const Cycle& cycle, int H);

/// Fills amplitude, first_harmonic, offset and sticking_fraction of a cycle from its trace of one period.
void measure(const Loop& loop, Cycle& cycle);

}  // namespace limcycle
