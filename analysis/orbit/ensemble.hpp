#pragma once
#include <functional>
#include <span>
#include <vector>

#include "limcycle/analysis/lanes/isa.hpp"
#include "limcycle/analysis/orbit/outcome_watch.hpp"

namespace limcycle {

/// One motion of many: a loop, which must outlive the run, and where it starts.
struct EnsembleMember {
  const Loop* loop = nullptr;
  LoopState start;
};

/// How long, how accurately and with how many threads an ensemble is marched.
struct EnsembleOptions {
  double rtol = 1e-8;              ///< in (0, 0.1], see loop_weights
  double duration = infinite;      ///< s, of every member
  long max_steps = 60000;          ///< of every member
  bool until_decided = true;       ///< else every member goes on to the end of the duration, which must be finite then
  double amplitude_floor = 1e-9;   ///< swings of y below this have died out
  double amplitude_ceiling = 1e6;  ///< |y| beyond this has diverged
  double accuracy = 1e-4;          ///< share by which the swings and the period of a cycle may still change
  Isa isa = best_isa();
  int lanes = 0;               ///< members that a thread marches at once; 0: as many as the instruction set has lanes
  int threads = 1;             ///< 0: one a core
  std::function<bool()> stop;  ///< asked now and then, one thread at a time: true ends the run
};

/// What became of a member.
struct EnsembleResult {
  Outcome outcome = Outcome::undecided;
  /// converged: decided, or marched to the end of the duration if that was wanted. incomplete: the duration was over
  /// first. max_iterations, stalled, not_finite, chattering: the march could not go on. interrupted: stopped.
  Status status = Status::interrupted;
  double period = 0.0;     ///< s, of a cycle; else 0
  double amplitude = 0.0;  ///< half the swing of y over one period of a cycle; else 0
  LoopState state;         ///< at the end
  double time = 0.0;       ///< s
  long steps = 0;          ///< accepted
  long refused = 0;        ///< tried and refused, in lanes
  bool in_lanes = false;   ///< else marched one by one
};

/// What became of every member.
struct EnsembleRun {
  std::vector<EnsembleResult> members;  ///< in the order of what was asked
  double occupancy = 1.0;               ///< share of the lanes that did useful work
};

/// Marches every member until it is clear what it comes to (see OutcomeWatch). Loops with 2 to 5 linear states and
/// LuGre friction, or Dahl's with exponent 1, as the only element are marched in lanes, like ones side by side, each
/// with its own time, step size and tolerances; all others by March, one by one.
///
/// The result of a member does not depend on the other ones, on their order or on the number of threads and lanes. It
/// is the same to the last bit for every instruction set. Throws std::invalid_argument for a bad option, a member
/// without a loop or with a start that does not fit it.
EnsembleRun run_ensemble(std::span<const EnsembleMember> members, const EnsembleOptions& options);

}  // namespace limcycle
