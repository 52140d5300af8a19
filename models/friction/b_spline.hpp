#pragma once
#include <algorithm>
#include <cstddef>
#include <span>

#include "limcycle/models/scalar.hpp"

namespace limcycle {

/// Index of the span of ascending `knots` (2 or more) that contains x: i for knots[i] <= x < knots[i + 1]; the first
/// span below the first knot and the last one from the last knot on. Cost O(log knots).
template <class S>
std::size_t span_of(std::span<const S> knots, const S& x) {
  const auto inner = knots.subspan(1, knots.size() - 2);
  const auto above = std::upper_bound(inner.begin(), inner.end(), x, [](const S& a, const S& b) { return a < b; });
  return static_cast<std::size_t>(above - inner.begin());
}

/// Cubic B-spline curve sum_k c_k B_k(x) on clamped knots (the end knots four-fold), with one coefficient per basis
/// function: knots + 2 of them. The curve begins at the first coefficient and ends at the last, lies between the least
/// and the largest of any four consecutive ones, and is C2; for x outside the knots it is constant.
/// de Boor's recursion, on any scalar, also with respect to knots and coefficients. De Boor (1972), J. Approx. Theory
/// 6, 50-62.
template <class S>
S cubic_b_spline(std::span<const S> knots, std::span<const S> coefficients, const S& x) {
  if (!(x > knots.front())) return coefficients.front();
  if (!(x < knots.back())) return coefficients.back();
  const std::size_t i = span_of(knots, x);
  const auto knot = [&](std::size_t clamped) -> const S& {  // numbered with the three repeated ones in front
    return knots[std::min(clamped < 3 ? 0 : clamped - 3, knots.size() - 1)];
  };
  S d[4] = {coefficients[i], coefficients[i + 1], coefficients[i + 2], coefficients[i + 3]};
  for (std::size_t r = 1; r <= 3; ++r) {
    for (std::size_t j = 3; j >= r; --j) {
      const S& left = knot(i + j);
      const S& right = knot(i + j + 4 - r);
      const S part = (x - left) / (right - left);
      d[j] = (S(1.0) - part) * d[j - 1] + part * d[j];
    }
  }
  return d[3];
}

}  // namespace limcycle
