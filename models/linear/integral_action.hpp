#pragma once
#include <optional>
#include <vector>

#include "limcycle/models/linear/state_space.hpp"

namespace limcycle {

/// numerator(s)/denominator(s), highest power first.
struct Rational {
  std::vector<double> numerator, denominator;
};

/// Of one input and one output, from its poles and zeros. `of` need not be minimal. Cost O(n^4).
Rational rational_of(const StateSpace& of);

/// The same without integral action: with the denominator s^k d(s), the k last coefficients of the numerator are
/// dropped and s^k cancels, which makes kd s + kp of (kd s^2 + kp s + ki)/s, and kp/(lag s + 1) of
/// (kp s + ki)/(s (lag s + 1)). Empty if there is no pole at the origin.
std::optional<Rational> without_integral_action(Rational of);

}  // namespace limcycle
