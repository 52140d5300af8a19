#pragma once
#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// Index in `cycles` of the same cycle (period and amplitude to 1e-6); a new cycle is added.
std::size_t merge(std::vector<Cycle>& cycles, const Cycle& cycle);

/// The known cycle to which a prediction refers: the one nearest to it, if its amplitude is within a factor of 10 and
/// its frequency within a factor of 3.
std::optional<std::size_t> nearest(const std::vector<Cycle>& cycles, const Prediction& prediction);

/// First harmonic and frequency within 5 % of those of the cycle.
bool is_close(const Prediction& prediction, const Cycle& cycle);

/// Sets cycle, verdict and sentence of a prediction that refers to this cycle: confirmed if it is close and
/// does not err about stability, biased otherwise.
void compare(Prediction& prediction, const std::vector<Cycle>& cycles, std::size_t cycle);

/// The same for a motion that has no period, by the means of its swings and their periods; false, and nothing is set,
/// if those are farther off than nearest() allows.
bool compare(Prediction& prediction, const IrregularMotion& motion);

/// Cycles to which no prediction of the method refers.
std::vector<Missed> missed_by(const std::string& method, const std::vector<Cycle>& cycles,
                              const std::vector<Prediction>& predictions);

/// True if the search of the method was complete, so that cycles that it did not find are missed.
bool searched_completely(const PredictReport& report, const std::string& method);

/// The stable cycle of largest amplitude, or null.
const Cycle* largest_stable(const std::vector<Cycle>& cycles);

}  // namespace limcycle
