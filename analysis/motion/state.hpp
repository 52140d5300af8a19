/// @file
/// The state vector that every stepper marches.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace limcycle {

/// State of x' = f(x, t), one entry per component, in the units of the model. A std::vector, because Boost.Odeint
/// resizes and copies it without an adapter.
using State = std::vector<double>;

inline bool is_finite(const State& x) {
  return std::ranges::all_of(x, [](double value) { return std::isfinite(value); });
}

}  // namespace limcycle
