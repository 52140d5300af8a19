#pragma once

namespace limcycle {

/// Maximum of a function of one variable between a and b, where `inside` is at least as high as both; golden section
/// with `evaluations` evaluations. Returns the place.
double golden_maximum(const auto& f, double a, double inside, double b, int evaluations) {
  constexpr double share = 0.38196601125010515;
  double x = inside, fx = f(inside);
  for (int k = 0; k < evaluations; ++k) {
    const double next = b - x > x - a ? x + share * (b - x) : x - share * (x - a);
    const double value = f(next);
    if (value > fx) {
      (next > x ? a : b) = x;
      x = next, fx = value;
    } else {
      (next > x ? b : a) = next;
    }
  }
  return x;
}

}  // namespace limcycle
