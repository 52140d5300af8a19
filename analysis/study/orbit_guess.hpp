#pragma once
#include <functional>

#include "limcycle/analysis/frequency/harmonic_balance.hpp"
#include "limcycle/analysis/orbit/multiple_shooting.hpp"

namespace limcycle {

/// A predicted oscillation as a guess for multiple shooting: the linear states are given by phase (0 to 2 pi), those of
/// the elements follow by letting the loop run from node to node twice round, the linear states being put back on the
/// prediction at every node.
OrbitGuess guess_orbit(const Loop& loop, const std::function<Eigen::VectorXd(double phase)>& linear_states,
                       double frequency, bool half, int nodes = 8);

/// Linear states of a loop on a harmonic balance, at a phase of its fundamental. `late`: by how much the elements act
/// later than their inputs say, where that is not in the states of the loop (a delayed relay), s.
Eigen::VectorXd linear_states(const Loop& loop, const HarmonicBalance& balance, double phase, double late);

}  // namespace limcycle
