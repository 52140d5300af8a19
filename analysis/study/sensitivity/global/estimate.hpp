#pragma once
#include <limits>
#include <optional>
#include <span>

namespace limcycle {

/// Estimate of a number from a sample, with the interval that contains it in 95 of 100 samples. Never NaN: an
/// undetermined value is not `known` (it is then 0, without meaning), and an undetermined interval is infinite.
struct Estimate {
  double value = 0.0;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool known = false;

  /// True if it has both a value and an interval.
  bool bounded() const { return known && high - low < std::numeric_limits<double>::infinity(); }
};

/// Answers of a model, row by row of a design. Empty: no answer (no cycle, undecided, not computed yet). An infinite
/// number or NaN also counts as no answer: no method here passes one on to a result.
using RowAnswers = std::span<const std::optional<double>>;

}  // namespace limcycle
