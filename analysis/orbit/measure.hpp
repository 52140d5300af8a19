#pragma once
#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/motion/march.hpp"

namespace limcycle {

/// Marches from `from` for the time `duration` and records it; steps are at most duration/`resolution`.
Status record(const Loop& loop, const LoopState& from, double duration, double rtol, int resolution, Trace& trace);

/// Appends one state to a trace. `field` must be in the modes of that state.
void append(Trace& trace, LoopField& field, const State& x, const State& dx, double t);

/// Extremes of y over a trace, each refined by the cubic through values and rates.
struct Extremes {
  double low = 0.0, high = 0.0;
};
Extremes extremes(const Trace& trace);

/// Harmonics 0..H of the input of the element of interest over one period, b + j a for b sin(n w t) + a cos(n w t), the
/// mean as j times itself.
Eigen::VectorXcd input_harmonics(const Cycle& cycle, int H);

/// Fills amplitude, first_harmonic, offset and sticking_fraction of a cycle from its trace of one period.
void measure(const Loop& loop, Cycle& cycle);

}  // namespace limcycle
