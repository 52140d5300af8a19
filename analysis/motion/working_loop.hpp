#pragma once
#include <optional>
#include <utility>

#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Gains of an element from its input and from the rate of its input.
using Gains = std::pair<double, double>;

/// The loop with those of its first `count` elements replaced that have gains other than {0, 0}. They keep their
/// places, without effect. Cost O(n^3) in the number of elements.
Loop with_gains(Loop loop, std::size_t count, Gains (*gains_of)(const Element&));

/// Largest output of an element that limits the command (saturation, clamped integrator); 0 for another.
double command_limit(const Element& element);
/// Gains of such an element within its limit; {0, 0} for another.
Gains within_limit(const Element& element);

/// A + A_delayed with every element that has a gain in normal operation (saturation, dead zone, backlash, quantizer)
/// replaced by that gain. Cost O(n^3).
Eigen::MatrixXd working_loop(const Loop& loop);

/// Gain of an integral that is the state of an element, as long as nothing holds it back.
std::optional<double> integral_gain(const Element& element);
/// True if that integral is reset.
bool resets_integral(const Element& element);

}  // namespace limcycle
