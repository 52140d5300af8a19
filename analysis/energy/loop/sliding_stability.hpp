#pragma once
#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/energy/decision.hpp"
#include "limcycle/analysis/energy/passivity/steady_slide.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Steady sliding of a loop (belt, shaft, ramp): the equilibrium at which the body rubs at a constant velocity.
struct SlidingStability {
  Answer stable;          ///< not_applicable: at rest the body does not rub; undecided: an eigenvalue on the axis
  double velocity = 0.0;  ///< of rubbing, m/s
  double force = 0.0;     ///< of friction, N
  LoopState point;        ///< the equilibrium
  Eigen::VectorXcd eigenvalues;  ///< of the exact Jacobian there, 1/s, rightmost first, without neutral states
  int neutral = 0;               ///< eigenvalues that are zero to rounding: states without effect
};
SlidingStability sliding_stability(const Loop& loop);

/// Speed at which the stability of steady sliding changes.
struct HopfPoint {
  double speed = 0.0;
  double frequency = 0.0;     ///< rad/s, of the oscillation that neither grows nor decays; 0: a real eigenvalue
  bool stable_above = false;  ///< sliding is stable at higher speeds
};

/// Options of the scan over the speed.
struct HopfOptions {
  int points = 96;  ///< of the scan, at equal ratios of the speed
  std::function<bool()> stop;
};

/// Speeds in [low, high] (0 < low < high) at which an eigenvalue of steady sliding crosses the imaginary axis, to a
/// relative 1e-10: a scan, extrema of the rightmost eigenvalue that come near the axis, and bisection. Changes closer
/// together than the scan and without an extremum that it finds are missed. Speeds at which there is no steady sliding
/// are skipped. Cost: some 40 eigenvalue problems a point. Throws std::invalid_argument for an invalid range.
std::vector<HopfPoint> sliding_stability_changes(const std::function<Loop(double)>& family, double low, double high,
                                                 const HopfOptions& options = {});

}  // namespace limcycle
