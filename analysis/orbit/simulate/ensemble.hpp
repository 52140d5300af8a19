#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "limcycle/analysis/lanes/isa.hpp"
#include "limcycle/analysis/orbit/settle/watch/outcome_watch.hpp"

namespace limcycle {

/// Tolerance of a simulation, and the swings that count as motion.
struct MotionBounds {
  double rtol = 1e-8;              ///< in (0, 0.1], see loop_weights
  double amplitude_floor = 1e-9;   ///< swings of y below this have died out
  double amplitude_ceiling = 1e6;  ///< |y| beyond this has diverged
};

/// One member of an ensemble: a loop, which must outlive the run, and its initial state.
struct EnsembleMember {
  const Loop* loop = nullptr;
  LoopState start;
  std::optional<MotionBounds> own{};  ///< in place of those of all members
};

/// Bounds of all members without their own, length and number of threads of an ensemble run.
struct EnsembleOptions : MotionBounds {
  double duration = infinite;  ///< s, of every member
  long max_steps = 60000;      ///< of every member
  bool until_decided = true;   ///< false: every member runs to the end of the duration, which must then be finite
  double accuracy = 1e-4;      ///< share by which the swings and the period of a cycle may still change
  Isa isa = best_isa();
  int lanes = 0;               ///< members that a thread marches at once; 0: as many as the instruction set has lanes
  int threads = 1;             ///< 0: one per core
  std::function<bool()> stop;  ///< called from time to time, one thread at a time: true ends the run
};

/// Result of a member.
struct EnsembleResult {
  Outcome outcome = Outcome::undecided;
  /// converged: decided, or marched to the end of the duration if until_decided is false. incomplete: the duration
  /// ended first. max_iterations, stalled, not_finite, chattering: the march could not continue. interrupted: stopped.
  Status status = Status::interrupted;
  double period = 0.0;     ///< s, of a cycle; else 0
  double amplitude = 0.0;  ///< half the swing of y over one period of a cycle; else 0
  LoopState state;         ///< at the end
  double time = 0.0;       ///< s
  long steps = 0;          ///< accepted
  long refused = 0;        ///< rejected steps, in lanes
  bool in_lanes = false;   ///< false: marched one by one
};

/// Results of all members.
struct EnsembleRun {
  std::vector<EnsembleResult> members;  ///< in the order of the members given
  double occupancy = 1.0;               ///< share of the lanes that did useful work
};

/// Marches every member until its outcome is decided (see OutcomeWatch). Loops with 2 to 5 linear states and LuGre
/// friction, or Dahl's with exponent 1, as the only element are marched in lanes, those of one shape together, each
/// with its own time, step size and tolerances; all others by March, one by one.
///
/// The result of a member does not depend on the other ones, on their order or on the number of threads and lanes. It
/// is the same to the last bit for every instruction set. Throws std::invalid_argument for a bad option, a member
/// without a loop or with a start that does not fit it.
EnsembleRun run_ensemble(std::span<const EnsembleMember> members, const EnsembleOptions& options);

}  // namespace limcycle
