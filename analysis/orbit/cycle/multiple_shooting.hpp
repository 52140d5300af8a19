#pragma once
#include <vector>

#include "limcycle/analysis/orbit/cycle/shooting.hpp"

namespace limcycle {

/// A periodic motion guessed as states at equal times of one period (half of it, if `half`).
struct OrbitGuess {
  std::vector<LoopState> nodes;  ///< at t = 0, T/K, 2T/K, ... ; element states and modes as on the motion
  double period = 0.0;           ///< of the whole period, s
  bool half = false;             ///< the other half is the reflection of this one
};

/// Multiple shooting: Newton for all nodes and the period at once, each segment integrated on its own with its exact
/// derivative (variational equations and saltation), so that the motion does not diverge within an iteration near a
/// strongly unstable cycle (Bulirsch and Stoer, Introduction to Numerical Analysis, section 7.3.5). Phase condition:
/// the first node moves at right angles to the flow. Steps of least norm where the system is singular (a family of
/// cycles). The result is then handed to single shooting, which gives its figures, error estimate and multipliers with
/// tight tolerances. Status as of shoot(). Cost an iteration: one period with derivative and a linear system of nodes x
/// states.
ShootingResult shoot_multiple(const Loop& loop, const OrbitGuess& guess, const ShootingOptions& options = {});

}  // namespace limcycle
