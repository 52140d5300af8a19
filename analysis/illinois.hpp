#pragma once
#include <cmath>
#include <optional>

namespace limcycle {

/// Where a function falls through zero between a, where it is fa > 0, and b, where it is fb < 0: regula falsi with the
/// end that stays halved (Illinois; Dowell and Jarratt 1971), until it is `close` to zero or the ends are 1e-15 apart,
/// with 60 evaluations at most. Returns the place, or the end beyond. `f` returns an empty optional where it has no
/// value: the middle of the bracket is then returned.
double falling_zero(const auto& f, double a, double fa, double b, double fb, double close) {
  for (int i = 0, side = 0; i < 60 && b - a > 1e-15; ++i) {
    const double c = b - fb * (b - a) / (fb - fa);
    const std::optional<double> fc = f(c);
    if (!fc) return 0.5 * (a + b);
    if (std::abs(*fc) <= close) return c;
    if (*fc < 0.0) {
      b = c;
      fb = *fc;
      if (side < 0) fa *= 0.5;
      side = -1;
    } else {
      a = c;
      fa = *fc;
      if (side > 0) fb *= 0.5;
      side = 1;
    }
  }
  return b;
}

}  // namespace limcycle
