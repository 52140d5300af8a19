#pragma once
#include <functional>
#include <string>
#include <vector>

#include "limcycle/analysis/motion/field/froude_clearance.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"

namespace limcycle {

/// Relative change of the swing below which it counts as unchanged: the line between "confirmed" and "biased"
/// elsewhere.
constexpr double unchanged_swing = 0.05;

/// One friction curve and contact of the Froude pendulum, with its initial conditions.
struct FroudeSetting {
  std::string name;      ///< "flat"
  std::string friction;  ///< as text
  FroudePendulum pendulum;
  SleeveContact contact;
  LuGre<double> law;
  double angle = 0.5;     ///< rad, at the start, at rest
  double settling = 0.0;  ///< s of motion without play before the comparison begins
  double duration = 8.0;  ///< s
  double left_out = 2.0;  ///< s at the start of the comparison, in which the sleeve settles
};

/// Motion with one clearance against that without play, over the same time from the same start.
struct FroudeComparison {
  double clearance = 0.0;  ///< m; 0: the motion without play itself
  FroudeRun run;
  double swing = 0.0;           ///< half peak-to-peak of the angle, rad
  double swing_change = 0.0;    ///< relative
  double angle_change = 0.0;    ///< rms of the difference over rms of the oscillating part without play
  double rubbing_peak = 0.0;    ///< largest |v|, m/s
  double rubbing_change = 0.0;  ///< rms of the difference over rms of v without play
  /// rms of the part above 20 times the frequency of small swings: of the angle (rad), v (m/s), N (N)
  double fast_angle = 0.0, fast_rubbing = 0.0, fast_normal = 0.0;
};

/// All clearances with one friction curve.
struct FroudeSeries {
  FroudeSetting setting;
  double small_frequency = 0.0;              ///< sqrt(mass gravity arm/inertia), rad/s
  double slope = 0.0;                        ///< dg/dv of the steady curve at the shaft's speed plus sigma2, N s/m
  std::vector<FroudeComparison> clearances;  ///< 0 first
  std::string finding;                       ///< one sentence with the numbers
};

struct FroudeResult {
  Status status = Status::converged;
  std::vector<FroudeSeries> series;
  /// Piatkowski and Wolski (2018): play up to 0.1 mm causes high-frequency oscillation but hardly changes angle or
  /// sliding velocity. States where that holds, and where not.
  std::string finding;
};

/// The settings of the experiment: friction that is flat (Coulomb), falls slightly, and falls as steeply as the hunting
/// pendulum of cases/froude-pendulum.toml needs, the last in a well damped contact and in a poorly damped one
/// (dissipation 20 and 2 s/m; a restitution of about 0.75 and 0.97 at 0.02 m/s). All numbers are limcycle's own choice.
std::vector<FroudeSetting> froude_settings();

/// Without play and with 0.02, 0.05 and 0.1 mm, unless others are given. The runs use `threads` threads (0: one per
/// core); some seconds. Status: that of the first run that did not converge, with the results so far.
FroudeResult froude_experiment(const std::vector<FroudeSetting>& settings = froude_settings(),
                               const std::vector<double>& clearances = {2e-5, 5e-5, 1e-4}, int threads = 2,
                               const std::function<bool()>& stop = {});

}  // namespace limcycle
