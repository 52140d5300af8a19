#pragma once
#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/energy/decision.hpp"
#include "limcycle/analysis/energy/steady_slide.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Steady sliding of a loop (belt, shaft, ramp): the equilibrium in which the body rubs at a constant velocity.
struct SlidingStability {
  Answer stable;          ///< not_applicable: at rest the body does not rub; undecided: an eigenvalue on the axis
  double velocity = 0.0;  ///< of rubbing, m/s
  double force = 0.0;     ///< of friction, N
  LoopState point;        ///< the equilibrium
  Eigen::VectorXcd eigenvalues;  ///< of the exact Jacobian there, 1/s, rightmost first, without neutral states
  int neutral = 0;               ///< eigenvalues that are zero to rounding: states that neither move nor matter
};
SlidingStability sliding_stability(const Loop& loop);

/// Where the stability of steady sliding changes as the speed does.
struct HopfPoint {
  double speed = 0.0;
  double frequency = 0.0;     ///< rad/s, of the oscillation that neither grows nor decays; 0: a real eigenvalue
  bool stable_above = false;  ///< sliding is stable at higher speeds
};

/// How finely speeds are scanned.
struct HopfOptions {
  int points = 96;  ///< of the scan, at equal ratios of the speed
  std::function<bool()> stop;
};

/// Speeds in [low, high] (0 < low < high) at which an eigenvalue of steady sliding crosses the imaginary axis, to 1e-10
/// of themselves: a scan, extrema of the rightmost eigenvalue that come near the axis, and bisection. Changes closer
/// together than the scan and without an extremum that it sees are missed. Speeds at which there is no steady sliding
/// are skipped. Cost: some 40 eigenvalue problems a point. Throws std::invalid_argument for a range that is none.
std::vector<HopfPoint> sliding_stability_changes(const std::function<Loop(double)>& family, double low, double high,
                                                 const HopfOptions& options = {});

}  // namespace limcycle
