#pragma once
#include <vector>

#include "limcycle/models/loop.hpp"

namespace limcycle {

/// The frequencies of a loop, rad/s, slowest first: the moduli of the poles of its linear part without the elements
/// (but with the tangent of gravity), and with those that have a gain (saturation, dead zone, backlash, quantizer)
/// replaced by it; without those at the origin (less than 1e-9 of the largest). If all poles are there, the frequency
/// at which the last element's output moves its input by the size over which it changes (a relay's hysteresis, a
/// Stribeck velocity); none without such a size. A delay is ignored. Cost O(n^3).
std::vector<double> pole_moduli(const Loop& loop);

/// Slowest time constant of a loop, s: the inverse of the first of pole_moduli(); 1 if the loop has no time scale of
/// its own.
double slow_time(const Loop& loop);

}  // namespace limcycle
