#pragma once
#include <cmath>
#include <numbers>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Common part of the memoryless elements with breaks at |x| = b. Modes: 0 inside, +1 above, -1 below.
template <class S>
struct TwoBreaks : Memoryless<S> {
  static constexpr bool piecewise_affine = true;
  int guards(Mode mode) const { return mode.value == 0 ? 2 : 1; }
  Mode next(const Input<S>&, Mode mode, std::span<S>, int fired) const {
    return {mode.value != 0 ? 0 : fired == 0 ? 1 : -1};
  }
  static void guard_at(const S& b, const Input<S>& in, Mode mode, std::span<S> g) {
    if (mode.value == 0) {
      g[0] = b - in.x;
      g[1] = b + in.x;
    } else {
      g[0] = mode.value == 1 ? in.x - b : -in.x - b;
    }
  }
  static Mode start_at(double b, const Input<double>& in) { return {in.x > b ? 1 : in.x < -b ? -1 : 0}; }

  /// f(u) = (2/pi)(asin u + u sqrt(1 - u^2)): describing function of the unit-slope saturation at u = b/A <= 1.
  static double inside_share(double u) {
    return u >= 1.0 ? 1.0 : 2.0 / std::numbers::pi * (std::asin(u) + u * std::sqrt((1.0 - u) * (1.0 + u)));
  }
};

}  // namespace limcycle
