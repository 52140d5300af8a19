#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/study/continuation/margin.hpp"
#include "limcycle/analysis/study/sensitivity/sensitivity.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// A parameter of a loop.
struct LoopNumber {
  std::string path, unit;
  double value = 0.0;
  std::function<std::optional<Loop>(double)> loop_at;  ///< empty if the value is not valid
};

/// Derivatives of a cycle of a loop by each of its numbers (see cycle_derivatives). A number at the border of its valid
/// range (a damping of 0) is changed to one side; one that changes the order of the loop (a time constant of 0) has no
/// derivative, and gives that reason. Throws what cycle_derivatives throws.
std::vector<LocalSensitivity> local_sensitivities(const Loop& loop, const Cycle& cycle,
                                                  const std::vector<LoopNumber>& numbers,
                                                  const std::function<bool()>& stop = {});

/// Derivatives by each number of the oscillations that the describing function predicts in a box (see
/// prediction_derivatives). None if it does not apply, or predicts none: `notes` give the reason.
std::vector<PredictedOscillation> predicted_sensitivities(const Loop& loop, const SearchBox& box,
                                                          const std::vector<LoopNumber>& numbers,
                                                          std::vector<std::string>& notes,
                                                          const std::function<bool()>& stop = {});

/// Derivatives of the threshold of one of the numbers by the others (see threshold_derivatives). `side` is a result of
/// margin(), `loop` and `numbers` are those at side.value, and `own` is the index of the number whose threshold it is.
std::vector<ThresholdNumber> threshold_sensitivities(const Loop& loop, const MarginSide& side,
                                                     const std::vector<LoopNumber>& numbers, std::size_t own,
                                                     const std::function<bool()>& stop = {});

}  // namespace limcycle
