#pragma once
#include <string>

#include "limcycle/analysis/orbit/simulate/simulate.hpp"

namespace limcycle {

/// Comparison of a run with a second run of the same motion at other tolerances.
struct Agreement {
  double rtol = 0.0;                     ///< of the second run; its absolute tolerances scale alike
  long steps = 0;                        ///< of the second run
  Status status = Status::converged;     ///< of the second run
  bool agrees = false;                   ///< neither the outcome nor the swings contradict one another
  bool verdict_agrees = false;           ///< the outcomes do not contradict one another, and cycles are the same one
  Outcome outcome = Outcome::undecided;  ///< of the second run
  double period_difference = 0.0;        ///< relative, of a cycle that both runs reach; NaN: there is none
  double amplitude_difference = 0.0;     ///< likewise
  double position_difference = 0.0;      ///< largest |y - y'| at like phase, over the range of y
  double phase_drift = 0.0;              ///< s, largest time shift of the swings of the second run
  double end_difference = 0.0;           ///< |y - y'| at the end, at the same time, over the range of y
  double parted = 0.0;                   ///< s, time from which y differs by more than `alike`; NaN: never
  std::string why;                       ///< unless they agree: one sentence
};

/// Tolerance of the second run: a hundredth of the first one's, so that the difference is the error of the first run
/// and not that of the second one (looser second runs raise false alarms), and no more than 1e-7, since two rough runs
/// may agree on the same false hunting. If double precision leaves no room for that, a hundred times the first one's.
double other_tolerance(double rtol);

/// Share of the range of y, at like phase, up to which two motions are alike.
inline constexpr double alike = 0.01;
/// Relative difference of period and amplitude up to which two cycles are the same one.
inline constexpr double same_cycle = 1e-3;

/// Repeats the run at other_tolerance() and compares outcome, cycle and motion. A drift in phase alone, as every long
/// run has, is no disagreement: the swings of both are compared one by one, each at its own time. Cost: a second run.
Agreement agreement(const Loop& loop, const SimulateOptions& options, const Simulation& run);
/// The same with a given tolerance of the second run.
Agreement agreement(const Loop& loop, SimulateOptions options, const Simulation& run, double rtol);

}  // namespace limcycle
