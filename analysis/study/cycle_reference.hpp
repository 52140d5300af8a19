#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/study/cycle_run.hpp"
#include "limcycle/analysis/study/predict.hpp"

namespace limcycle {

/// A stable limit cycle known well enough to measure other methods by.
struct CycleReference {
  Cycle cycle;
  State sizes;                  ///< of its linear states
  std::string made_by;          ///< "shooting at rtol 3e-12 (rodas5p)"
  std::string verified_by;      ///< the second method, in words; empty: none could
  bool independent = false;     ///< it is another stepper, not the same one at another tolerance
  double agreement = infinite;  ///< relative difference of period and amplitude between both
  double error = infinite;      ///< what errors below cannot be told from: the larger of agreement and own estimate

  /// The second method agrees to within 1e-6.
  bool verified() const { return agreement < 1e-6; }
};

/// The stable limit cycle that simulations from several starts reach (the first of several), solved again by shooting
/// at a tight tolerance from `near` if that is given, and checked by simulating ten of its periods with other steppers,
/// the same one at another tolerance being the last resort. Empty: no stable cycle was found; `why` then says what was.
/// The loop is without delay. max_steps: budget of the check.
std::optional<CycleReference> cycle_reference(const Loop& loop, const PredictOptions& options, long max_steps,
                                              std::string& why);

/// The check alone, of a cycle that is known.
void verify(const Loop& loop, CycleReference& reference, long max_steps, const std::function<bool()>& stop);

/// Largest relative difference of period and amplitude.
double relative_error(const CycleRun& run, const Cycle& cycle);

}  // namespace limcycle
