#pragma once
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/study/precision/fixed_step.hpp"

namespace limcycle {

/// A marching method with its setting: a stepper with its relative tolerance, or a fixed method with its step, s.
struct MarchMethod {
  std::variant<StepperKind, FixedMethod> kind;
  double setting = 0.0;
  bool plain = false;  ///< of a stepper: one absolute tolerance for all states, equal to the relative one
  bool fixed() const { return std::holds_alternative<FixedMethod>(kind); }
  std::string name() const;
};

/// Settings of the watch of a run.
struct InstrumentedRunOptions {
  Section section;              ///< its crossings are recorded
  double duration = 0.0;        ///< s
  double last = 0.0;            ///< s: length of the end of the run over which the swing is measured
  std::vector<double> samples;  ///< s, in order: times at which y is recorded
  double evaluations = 2e6;     ///< limit, of a right side of four components
  std::function<bool()> stop;
};

/// Result of a run by any method.
struct InstrumentedRun {
  Status status = Status::converged;
  bool gave_up = false;
  std::vector<double> crossings;  ///< s, of the section
  std::vector<double> y;          ///< at the samples
  double swing = 0.0;             ///< largest less smallest y over the last part, at ends of steps
  double peak = 0.0;              ///< largest |output| of the last element at ends of steps
  long reversals = 0;             ///< of the rate of the last element's input
  long steps = 0;
};

/// Marches the loop from `start` at t = 0. Steppers locate crossings exactly; fixed steps interpolate them.
InstrumentedRun instrumented_run(const Loop& loop, const LoopState& start, const MarchMethod& method,
                                 const InstrumentedRunOptions& options);

}  // namespace limcycle
