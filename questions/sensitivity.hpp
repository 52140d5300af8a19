#pragma once
#include <string>
#include <utility>
#include <vector>

#include "limcycle/analysis/study/sensitivity/sensitivity.hpp"
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/questions/asking/asking.hpp"

namespace limcycle {

/// Size and parts of a study of sensitivity.
struct SensitivityWishes {
  int samples = 0;       ///< of Sobol's study; 0: of the case
  int trajectories = 0;  ///< of Morris' study; 0: a tenth of the samples, 10 to 100
  bool second_order = false;
  std::vector<double> factors{0.5, 2.0};  ///< on each number, one at a time
  bool local_only = false;                ///< derivatives and one at a time only
  std::vector<std::string> thresholds;    ///< paths of the numbers whose threshold of hunting is wanted
  bool nearby = true;                     ///< false: only the sweep over the spread, as ranks that help with it do
};

/// Base samples of the Sobol study and trajectories of the Morris study.
std::pair<int, int> sizes_of(const SensitivityWishes& wishes, const ParameterSpread& spread);

/// The spread of [sensitivity], or each number of the case by +-20 %; with the seed of `asking` unless that is 0.
ParameterSpread spread_of(const Case& from, const Asking& asking);

/// Throws InputError if the study would not fit into memory. `dashes`: what stands before the names of its arguments.
void need_memory_for(const SensitivityWishes& wishes, const ParameterSpread& spread, const std::string& dashes);

/// Flags of the program that wish the same.
std::string flags_of(const SensitivityWishes& wishes, std::uint64_t seed);

/// Derivatives of the largest stable cycle, thresholds, changes one at a time, and the study over the spread. Throws
/// InputError if the case has no loop, or a threshold is of no number (threshold_numbers() finds that at once).
SensitivityReport ask_sensitivity(const Case& from, const SensitivityWishes& wishes, const Asking& asking,
                                  const SweepRunner& sweep, Status& status);

}  // namespace limcycle
