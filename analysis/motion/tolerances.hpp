#pragma once
#include <vector>

#include "limcycle/analysis/motion/error_weights.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// The frequencies of a loop, rad/s, slowest first: the moduli of the poles of its linear part without the elements
/// (but with the tangent of gravity), and with those that have a gain (saturation, dead zone, backlash, quantizer)
/// replaced by it; without those at the origin (less than 1e-9 of the largest). If all poles are there, the frequency
/// at which the last element's output moves its input by the size over which it changes (a relay's hysteresis, a
/// Stribeck velocity); none without such a size. A delay is ignored. Cost O(n^3).
std::vector<double> pole_moduli(const Loop& loop);

/// A + A_delayed with every element that has a gain in normal operation (saturation, dead zone, backlash, quantizer)
/// replaced by that gain. Cost O(n^3).
Eigen::MatrixXd working_loop(const Loop& loop);

/// Slowest time constant of a loop, s: the inverse of the first of pole_moduli(); 1 if the loop has no time scale of
/// its own.
double slow_time(const Loop& loop);

/// Typical output of an element of the loop: that of its Scales; of a cubic, which has no size of its own, the output
/// c A^3 at the input A for which c A^2 times the largest response |H(s)| of the loop, at s = (0.1 + j) w for its
/// frequencies w, is 1.
double output_level(const Loop& loop, std::size_t element);

/// Typical size of every state of the loop (linear states, then element states): the largest response of the linear
/// part, over the frequencies of its poles, to the element outputs. Position and velocity at a friction law are bounded
/// by the law's own displacement and velocity scales, which its switching from stick to slip requires.
State typical_sizes(const Loop& loop);

/// Typical rubbing velocity of the last element, from typical_sizes() and the speed of the other surface.
double typical_rubbing_velocity(const Loop& loop);

/// True if a curve of the loop begins at rest with infinite slope (Stribeck with delta < 1).
bool has_infinite_slope(const Loop& loop);

/// Tolerances for marching the loop at relative tolerance rtol: absolute ones are rtol times a thousandth of the
/// typical size, or the law's own scale if that is smaller (a loose tolerance on v breaks stiction early and lands on a
/// false cycle). Throws std::invalid_argument if rtol is not in (0, 0.1].
ErrorWeights loop_weights(const Loop& loop, double rtol);
/// The same for known typical_sizes(); `stuck`: for a time in which no body moves, so that none passes the steep part
/// of a curve about rest.
ErrorWeights loop_weights(const Loop& loop, double rtol, State typical, bool stuck = false);

}  // namespace limcycle
