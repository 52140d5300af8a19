#pragma once
#include <limits>
#include <optional>
#include <span>

namespace limcycle {

/// What a sample says of a number, with the interval that holds it in 95 of 100 samples. Never NaN: what cannot be told
/// is not `known` (the value is 0 then, and stands for nothing), and an interval that cannot be told is infinite.
struct Estimate {
  double value = 0.0;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool known = false;

  /// Has both a value and an interval.
  bool bounded() const { return known && high - low < std::numeric_limits<double>::infinity(); }
};

/// What a model answered, row by row of a design. Empty: no answer (no cycle, undecided, not computed yet). An infinite
/// number or NaN is taken for no answer too: no method here lets one through to a result.
using RowAnswers = std::span<const std::optional<double>>;

}  // namespace limcycle
