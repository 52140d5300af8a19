#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "limcycle/analysis/status.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// A law under prescribed velocity.
struct VelocityRun {
  std::vector<double> t, x, v, F;
  Status status = Status::converged;

  /// Force at a velocity on one branch: the samples with dv/dt of that sign, interpolated; NaN outside.
  double force_at(double velocity, bool accelerating) const;
};

/// v = mean + amplitude cos(frequency t): one period of the steady state (of the motion itself after `periods` periods
/// if no periodic state was found: Status::incomplete), from a velocity reversal on. F is NaN if a law needs the
/// applied force, which prescribed motion does not have.
VelocityRun run_velocity(const Element& law, double mean, double amplitude, double frequency, int periods = 20);

/// The virgin law at constant velocity, from t = 0 to `duration` (s).
VelocityRun run_constant_velocity(const Element& law, double velocity, double duration);

}  // namespace limcycle
