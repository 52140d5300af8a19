#pragma once
#include <functional>
#include <string>
#include <vector>

#include "limcycle/analysis/motion/state.hpp"
#include "limcycle/analysis/status.hpp"
#include "limcycle/models/froude_clearance.hpp"

namespace limcycle {

struct FroudeOptions {
  double duration = 10.0;  ///< s
  double sample = 2e-4;    ///< s, interval of the rows of the trace
  double rtol = 1e-7;      ///< 1e-12..1e-3
  long max_steps = 5'000'000;
  std::function<bool()> stop;
};

/// A motion, sampled evenly.
struct FroudeTrace {
  std::vector<double> t;        ///< s
  std::vector<double> angle;    ///< rad
  std::vector<double> rubbing;  ///< velocity of the sleeve over the shaft, m/s; of the sleeve's inside without contact
  std::vector<double> normal;   ///< contact force N, N
  std::vector<double> eccentricity;  ///< distance of the two centres, m
};

struct FroudeRun {
  Status status = Status::converged;
  std::string why;  ///< a sentence, unless converged
  FroudeTrace trace;
  State last;                 ///< state at the end: of FroudeClearance, or of FroudeRigid
  double energy_error = 0.0;  ///< largest defect of the energy balance over the energy of the swing (with play only)
  double time_apart = 0.0;    ///< s, time without contact
  long losses = 0;            ///< number of losses of contact
  long steps = 0;
};

/// Marches the pendulum with play by Rodas5p with exact Jacobians; the loss and the gain of contact are located to
/// rounding. Throws std::invalid_argument on a broken rule, a clearance of 0 or options out of range. Status:
/// converged, interrupted, max_iterations (max_steps), stalled (no progress in a step or at a switch), not_finite.
FroudeRun march_froude(const FroudeClearance<double>& model, State start, const FroudeOptions& options);

/// The same without play.
FroudeRun march_froude(const FroudeRigid<double>& model, State start, const FroudeOptions& options);

/// The pendulum at this angle and angular velocity, the bristle deflected by z, the sleeve at its position of rest
/// under its load without the swing: the penetration is that under N0, straight above the arm.
State resting_sleeve(const FroudeClearance<double>& model, double angle, double angle_rate, double z);

}  // namespace limcycle
