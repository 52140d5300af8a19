/// @file
/// The one enumeration for the end of a method of analysis, carried by every result.
#pragma once

#include <string_view>

namespace limcycle {

/// End of a method. Only `converged` and `no_cycle` are answers; for every other value there is none (or a partial
/// one), and numbers that come with it are the best known, to be used with that reservation. Bad input is not a status:
/// it throws std::invalid_argument.
enum class Status {
  /// Finished: the result meets the requested tolerance.
  converged,
  /// The limit of iterations, steps or evaluations was reached first.
  max_iterations,
  /// No further progress is possible (step too small, singular Jacobian) and the tolerance is not met.
  stalled,
  /// A NaN or infinity appeared, or the function is undefined where it is needed.
  not_finite,
  /// Finished: there is no cycle (no root, motion comes to rest) in the region that was searched.
  no_cycle,
  /// Switching events accumulate without end (Zeno behaviour) and the motion cannot be carried past them.
  chattering,
  /// Finished, but a check shows that something may be missing (e.g. a region stayed undecided).
  incomplete,
  /// The caller asked to stop; what was computed until then is kept.
  interrupted,
  /// The question has no answer here: the law needs the applied force, which a prescribed motion does not have (see
  /// analysis/frequency/describing_function/df_undefined.hpp).
  undefined
};

/// Name of the status, spelled as the enumerator.
constexpr std::string_view to_string(Status status) {
  switch (status) {
    case Status::converged:
      return "converged";
    case Status::max_iterations:
      return "max_iterations";
    case Status::stalled:
      return "stalled";
    case Status::not_finite:
      return "not_finite";
    case Status::no_cycle:
      return "no_cycle";
    case Status::chattering:
      return "chattering";
    case Status::incomplete:
      return "incomplete";
    case Status::interrupted:
      return "interrupted";
    case Status::undefined:
      return "undefined";
  }
  return "unknown";
}

}  // namespace limcycle
