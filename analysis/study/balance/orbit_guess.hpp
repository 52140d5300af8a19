#pragma once
#include <functional>

#include "limcycle/analysis/frequency/harmonic_balance/harmonic_balance.hpp"
#include "limcycle/analysis/orbit/cycle/multiple_shooting.hpp"

namespace limcycle {

/// A predicted oscillation as a guess for multiple shooting: the linear states are given by phase (0 to 2 pi); those of
/// the elements follow from a run of the loop from node to node over two periods, in which the linear states are reset
/// to the prediction at every node.
OrbitGuess guess_orbit(const Loop& loop, const std::function<Eigen::VectorXd(double phase)>& linear_states,
                       double frequency, bool half, int nodes = 8);

/// Linear states of a loop on a harmonic balance, at a phase of its fundamental. `late`: delay of the elements' action
/// after their inputs, if it is not in the states of the loop (a delayed relay), s.
Eigen::VectorXd linear_states(const Loop& loop, const HarmonicBalance& balance, double phase, double late);

}  // namespace limcycle
