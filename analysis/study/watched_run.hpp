#pragma once
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/study/fixed_step.hpp"

namespace limcycle {

/// A way to march, with its setting: a stepper with its relative tolerance, or a fixed method with its step, s.
struct MarchMethod {
  std::variant<StepperKind, FixedMethod> kind;
  double setting = 0.0;
  bool plain = false;  ///< of a stepper: one absolute tolerance for all states, equal to the relative one
  bool fixed() const { return std::holds_alternative<FixedMethod>(kind); }
  std::string name() const;
};

/// What to watch a run for.
struct WatchOptions {
  Section section;              ///< its crossings are recorded
  double duration = 0.0;        ///< s
  double last = 0.0;            ///< s: the end of the run whose swing is told
  std::vector<double> samples;  ///< s, in order: y there is told
  double evaluations = 2e6;     ///< of a right side of four components; then the run is given up
  std::function<bool()> stop;
};

/// What a run does, whatever marches it.
struct WatchedRun {
  Status status = Status::converged;
  bool gave_up = false;
  std::vector<double> crossings;  ///< s, of the section
  std::vector<double> y;          ///< at the samples
  double swing = 0.0;             ///< greatest less least y over the last part, at ends of steps
  double peak = 0.0;              ///< largest |output| of the last element at ends of steps
  long reversals = 0;             ///< of the rate of the last element's input
  long steps = 0;
};

/// Marches the loop from `start` at t = 0. Crossings are landed on by steppers, and interpolated in fixed steps.
WatchedRun watched_run(const Loop& loop, const LoopState& start, const MarchMethod& method,
                       const WatchOptions& options);

}  // namespace limcycle
