#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/orbit/branch/branch_map.hpp"
#include "limcycle/analysis/status.hpp"

namespace limcycle {

/// Range, accuracy and limits of a continuation.
struct ContinuationOptions {
  double from = 0.0, to = 0.0;  ///< range of the parameter
  // Steps are arclength in (orbit in units of its own size, 6 times the share of the range).
  double first_step = 0.04;
  double min_step = 1e-7;
  double max_step = 0.24;                 ///< 25 points or more over the range
  int max_points = 300;                   ///< in each direction
  long max_steps = 100'000'000;           ///< of the integrations, in each direction
  double accuracy = 1e-8;                 ///< wanted relative error of period and amplitude
  bool until_event = false;               ///< stop at the first fold or change of stability in each direction
  bool upwards = true, downwards = true;  ///< towards `to`, towards `from`, from the start
  std::function<bool()> stop;
  std::function<void(double)> progress;  ///< share of the range covered so far
};

/// A cycle of a branch and the value of the parameter that it belongs to.
struct BranchPoint {
  double parameter = 0.0;
  Cycle cycle;  ///< without its trace
};

/// Something that happens on a branch.
struct BranchEvent {
  enum class Type { fold, stability, end } type = Type::end;
  double parameter = 0.0;
  double error = 0.0;  ///< estimated error of the parameter, relative to it; NaN for an end that was not located
  double period = 0.0, amplitude = 0.0;
  std::size_t point = 0;  ///< index of the point of the branch at the event, or of the last point before an end
  std::string why;        ///< one sentence
};
std::string_view to_string(BranchEvent::Type type);

/// A branch of cycles in order, from one end to the other.
struct Branch {
  std::vector<BranchPoint> points;
  std::vector<BranchEvent> events;
  Status status = Status::converged;
  std::string why;  ///< if it could not start
  long maps = 0;
};

/// Follows a limit cycle in one parameter, both ways from `start` (a cycle of the loop at p0): pseudo-arclength
/// continuation of the fixed point of the (half) return map (H. B. Keller, 1977). The section moves along with the
/// orbit. Corrector: Newton on [DP - I, dP/ds; tangent]; the step follows its contraction and the turn of the tangent,
/// so that folds are passed and unstable parts followed.
///
/// Events: `fold` (the parameter turns back; located where the tangent has no part along it, which leaves an error of
/// second order), `stability` (a multiplier crosses the unit circle away from a fold; `why` describes it), `end` (`why`
/// gives the reason). Errors of parameters come from the disagreement of two integration tolerances. Status: converged
/// (every end explained), incomplete (an end that is not understood), max_iterations (limit of points or steps),
/// interrupted (what was computed is kept), stalled or another (the start is not on a cycle). Throws
/// std::invalid_argument for a bad range or a start outside it. Limits: a pair of folds, or of changes of stability,
/// that lies within one step is missed (max_step narrows that); a cycle whose multipliers exceed some thousands is
/// followed only for a while. Cost: one or two return maps a point, and two loose ones, of which one with its
/// derivative.
Branch continue_cycle(const LoopFamily& family, const Cycle& start, double p0, const ContinuationOptions& options);

}  // namespace limcycle
