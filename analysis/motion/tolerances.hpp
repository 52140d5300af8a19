#pragma once
#include <vector>

#include "limcycle/analysis/motion/error_weights.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Moduli of the poles of the linear part without the elements (but with the tangent of gravity), rad/s, slowest first;
/// without those at the origin (less than 1e-9 of the largest). Without its delay, if there is one. Cost O(n^3).
std::vector<double> pole_moduli(const Loop& loop);

/// Typical size of every state of the loop (linear states, then element states): the largest response of the linear
/// part, over the frequencies of its poles, to the element outputs. Position and velocity at a friction law are bounded
/// by the law's own displacement and velocity scales, which are the ones that its switching from stick to slip needs.
State typical_sizes(const Loop& loop);

/// Tolerances for marching the loop at relative tolerance rtol: absolute ones are rtol times a thousandth of the
/// typical size, or the law's own scale where that is smaller (a loose tolerance on v breaks stiction early and lands
/// on a false cycle). Throws std::invalid_argument if rtol is not in (0, 0.1].
ErrorWeights loop_weights(const Loop& loop, double rtol);
/// The same, where typical_sizes() are known already.
ErrorWeights loop_weights(const Loop& loop, double rtol, State typical);

}  // namespace limcycle
