#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/study/precision/integrator_check.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// A stable limit cycle accurate enough as a reference for other methods.
struct CycleReference {
  Cycle cycle;
  State sizes;                  ///< of its linear states
  std::string made_by;          ///< "shooting at rtol 3e-12 (rodas5p)"
  std::string verified_by;      ///< the second method, as text; empty: none was possible
  bool independent = false;     ///< it is another stepper, not the same one at another tolerance
  double agreement = infinite;  ///< relative difference of period and amplitude between both
  double error = infinite;      ///< uncertainty of measured errors: the larger of agreement and own estimate

  /// The second method agrees to within 1e-6.
  bool verified() const { return agreement < 1e-6; }
};

/// The stable limit cycle that simulations from several starts reach (the first of several), solved again by shooting
/// at a tight tolerance from `near` if that is given, and checked by simulating ten of its periods with other steppers,
/// or as the last resort with the same one at another tolerance. Empty: no stable cycle was found; `why` then gives the
/// result. The loop has no delay. max_steps: limit of the check.
std::optional<CycleReference> cycle_reference(const Loop& loop, const PredictOptions& options, long max_steps,
                                              std::string& why);

/// The check alone, for a known cycle.
void verify(const Loop& loop, CycleReference& reference, long max_steps, const std::function<bool()>& stop);

/// Largest relative difference of period and amplitude.
double relative_error(const IntegratorCheck& run, const Cycle& cycle);

}  // namespace limcycle
