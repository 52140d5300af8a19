#pragma once
#include <vector>

#include "limcycle/analysis/motion/error_weights.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

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
