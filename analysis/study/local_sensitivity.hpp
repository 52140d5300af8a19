#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/study/margin.hpp"
#include "limcycle/analysis/study/sensitivity.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// A number that a loop is made of.
struct LoopNumber {
  std::string path, unit;
  double value = 0.0;
  std::function<std::optional<Loop>(double)> loop_at;  ///< empty where the value is not valid
};

/// How a cycle of a loop moves with each of its numbers (see cycle_derivatives). A number at the border of what is
/// valid (a damping of 0) is moved to one side; one that changes the order of the loop (a time constant of 0) has no
/// derivative, and says so. Throws what cycle_derivatives throws.
std::vector<LocalSensitivity> local_sensitivities(const Loop& loop, const Cycle& cycle,
                                                  const std::vector<LoopNumber>& numbers,
                                                  const std::function<bool()>& stop = {});

/// How the oscillations that the describing function predicts in a box move with each number (see
/// prediction_derivatives). None where it does not apply, or predicts none: `notes` say which.
std::vector<PredictedOscillation> predicted_sensitivities(const Loop& loop, const SearchBox& box,
                                                          const std::vector<LoopNumber>& numbers,
                                                          std::vector<std::string>& notes,
                                                          const std::function<bool()>& stop = {});

/// How the threshold of one of the numbers moves with the others (see threshold_derivatives). `side` is what margin()
/// found, `loop` and `numbers` are those at side.value, and `own` is the index of the number whose threshold it is.
std::vector<ThresholdNumber> threshold_sensitivities(const Loop& loop, const MarginSide& side,
                                                     const std::vector<LoopNumber>& numbers, std::size_t own,
                                                     const std::function<bool()>& stop = {});

}  // namespace limcycle
