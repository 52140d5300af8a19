#pragma once
#include "limcycle/analysis/energy/passivity/motions.hpp"

namespace limcycle {

/// Check of the storage function that a law offers: supply F v >= dU/dt in every state and mode reached, for every
/// velocity; supply >= rise of U along every motion, switches included.
struct Certificate {
  bool offered = false;  ///< the law has a storage function for its parameters
  bool holds = false;
  long states = 0;        ///< number of states checked, each at all velocities
  double least = 0.0;     ///< least F v - dU/dt over |F v| + |dU/dt|
  double velocity = 0.0;  ///< m/s, velocity of `least`
  Status status = Status::converged;
};

/// The states are those reached by known and random motions from the law without history. A negative F v - dU/dt counts
/// unless a change of the states by 1e-12 of their scales explains it, or a neighbour at 1e-8 satisfies the balance
/// (laws hold modes a little beyond their ends, so that roundings do not switch them). Cost: `effort` times some 10^6
/// evaluations of the law.
Certificate certify(const Element& element, const MotionScales& scales, const PassivityOptions& options);

}  // namespace limcycle
