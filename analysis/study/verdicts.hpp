#pragma once
#include "limcycle/analysis/study/predict.hpp"

namespace limcycle {

/// Index of the cycle in `cycles` that is `cycle` (same period and amplitude to 1e-6), added if it is new.
std::size_t merge(std::vector<Cycle>& cycles, const Cycle& cycle);

/// The known cycle that a prediction is about: the one nearest to it, if its amplitude is within a factor of 10 and its
/// frequency within a factor of 3.
std::optional<std::size_t> nearest(const std::vector<Cycle>& cycles, const Prediction& prediction);

/// Sets cycle, verdict and sentence of a prediction that is about this cycle: confirmed if first harmonic and frequency
/// are within 5 %, biased otherwise.
void compare(Prediction& prediction, const std::vector<Cycle>& cycles, std::size_t cycle);

/// Cycles that no prediction of the method is about.
std::vector<Missed> missed_by(const std::string& method, const std::vector<Cycle>& cycles,
                              const std::vector<Prediction>& predictions);

/// Whether the method looked everywhere where it was to look, so that what it did not find it misses.
bool searched_completely(const PredictReport& report, const std::string& method);

/// The stable cycle of largest amplitude, or null.
const Cycle* largest_stable(const std::vector<Cycle>& cycles);

}  // namespace limcycle
