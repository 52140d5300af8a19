#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
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

/// The value below which a share (0..1) of a sorted sample lies, by linear interpolation between neighbours (R. J.
/// Hyndman and Y. Fan, 1996, definition 7). The sample must not be empty.
inline double percentile(std::span<const double> sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place), above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

}  // namespace limcycle
