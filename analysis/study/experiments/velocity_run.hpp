#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "limcycle/analysis/status.hpp"
#include "limcycle/models/elements.hpp"

namespace limcycle {

/// A law under prescribed velocity.
struct VelocityRun {
  std::vector<double> t, x, v, F;
  Status status = Status::converged;

  /// Force at a velocity on one branch: the samples with dv/dt of that sign, interpolated; NaN outside.
  double force_at(double velocity, bool accelerating) const;
};

/// v = mean + amplitude cos(frequency t): one period of the steady state (of the motion itself after `periods` periods
/// where no periodic state was found: Status::incomplete), from a velocity reversal on. F is NaN where a law needs the
/// applied force, which prescribed motion does not have.
VelocityRun run_velocity(const Element<double>& law, double mean, double amplitude, double frequency, int periods = 20);

/// The virgin law at constant velocity, from t = 0 to `duration` (s).
VelocityRun run_constant_velocity(const Element<double>& law, double velocity, double duration);

/// Half-width of the band of velocities in which the law needs the applied force; 0 for the others.
double band_of_applied_force(const Element<double>& law);

}  // namespace limcycle
