#pragma once
#include "limcycle/analysis/energy/motions.hpp"

namespace limcycle {

/// Whether the storage function that a law offers is one: supply F v >= dU/dt in every state and mode that was reached,
/// for every velocity; supply >= rise of U along every motion, switches included.
struct Certificate {
  bool offered = false;  ///< the law has a storage function for its parameters
  bool holds = false;
  long states = 0;        ///< that it was checked in, each at all velocities
  double least = 0.0;     ///< least F v - dU/dt over |F v| + |dU/dt|
  double velocity = 0.0;  ///< m/s, where that is
  Status status = Status::converged;
};

/// The states are those that known and random motions lead to, from the law without history. A negative F v - dU/dt
/// counts where neither states that are off by 1e-12 of their scales would explain it, nor a neighbour at 1e-8 is in
/// order (laws hold modes a little beyond their ends, so that roundings do not switch them). Cost: `effort` times some
/// 10^6 evaluations of the law.
Certificate certify(const ErasedElement<double>& element, const MotionScales& scales, const PassivityOptions& options);

}  // namespace limcycle
