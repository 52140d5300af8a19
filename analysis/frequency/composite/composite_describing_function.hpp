#pragma once
#include <complex>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "limcycle/analysis/status.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// Point of a composite describing function: u = bias + force sin(frequency t). The bias is either given, or solved for
/// so that the rubbing velocity has the given mean.
struct CompositePoint {
  double force = 0.0;               ///< amplitude U of u, > 0, N
  double frequency = 0.0;           ///< > 0, rad/s
  double mean_velocity = 0.0;       ///< of the rubbing motion (belt, ramp), m/s
  std::optional<double> bias = {};  ///< N; if it is given, mean_velocity is a result only
};

/// Options of a composite describing function.
struct CompositeOptions {
  int harmonics = 1;           ///< orders 1..harmonics of x are returned, 1..64
  double accuracy = 1e-6;      ///< wanted relative error of the gain, 1e-11..1e-1
  bool estimate_error = true;  ///< solve at two tolerances and compare; false: `error` is that of periodicity only
};

/// Periodic steady state of mass and friction under a harmonic force.
struct CompositeResponse {
  std::complex<double> gain;                    ///< N = x1/u1, m/N; 0 exactly: stuck for ever
  double bias = 0.0;                            ///< mean of u = mean friction force, N
  double mean_velocity = 0.0;                   ///< of the rubbing motion, m/s
  std::vector<std::complex<double>> harmonics;  ///< of x about its mean motion, m: [k-1] = sine + j cosine coefficient
  double dissipation = 0.0;                     ///< work per period against the law, J
  double sticking_fraction = 0.0;  ///< share of the period truly stuck; laws without a stuck mode: |v| < vs/100
  double peak_speed = 0.0;         ///< largest |rubbing velocity| met, m/s
  double error = 0.0;              ///< estimated relative error of the gain
  bool symmetric = false;          ///< solved as half-wave symmetric, with bias 0
  std::vector<double> start;       ///< rubbing velocity and states of the law at phase 0
  Mode mode{};                     ///< of the law there
  Status status = Status::converged;
  int maps = 0;    ///< half or whole periods marched
  long steps = 0;  ///< of the integrator
};

/// Describing function of mass and friction taken as one element with input u (force) and output x (position), after
/// Olsson (1995, 1996): m dv/dt = u - F(v, z), sticking included, so that the mass has the true friction and the
/// friction the true (not sinusoidal) velocity. N -> -1/(m w^2) where friction is negligible, about 1/sigma0 below
/// break-away, and for F_s > F_c it jumps at the break-away amplitude.
///
/// The periodic state is the fixed point of the period map of (v, z), by plain maps as long as they contract and
/// Newton's method else; of the half-period map if the law is odd and the mean velocity 0 (bias 0 then; other periodic
/// states, which a law that sticks may have, are not looked for). Otherwise the bias is one more unknown.
/// One object serves one thread. Cost: 40 to 300 steps a map, 2 to 8 maps a point with a neighbour to start from.
class CompositeDescribingFunction {
 public:
  /// Throws std::invalid_argument if the element is not a friction law or the mass is not positive.
  CompositeDescribingFunction(const Element& friction, double mass);
  ~CompositeDescribingFunction();
  CompositeDescribingFunction(CompositeDescribingFunction&&) noexcept;
  CompositeDescribingFunction& operator=(CompositeDescribingFunction&&) noexcept;

  /// `near`: a periodic state close by, to start from. Throws std::invalid_argument for a point or an option out of its
  /// range. If no solution is found, the Status gives the reason and the gain is 0.
  CompositeResponse operator()(const CompositePoint& point, const CompositeOptions& options = {},
                               const CompositeResponse* near = nullptr);

  /// Amplitude of the force at which the body breaks away, mean velocity 0: the largest for which a body that starts at
  /// rest does not pass the velocity scale of the law (laws with a stuck mode: does not slide) in a period. `relative`:
  /// wanted relative width of the bracket. `guess`: a value near it, or 0.
  double break_away(double frequency, double relative, double guess = 0.0);

  /// The same for a biased force: the bias, of the sign of `direction`, at which the body begins to break away in that
  /// direction in every period; may be of the other sign when the force alone is large.
  double break_away_bias(double force, double frequency, double direction, double relative);

  /// Sets a function that is called at least every 256 steps of the integrator; true ends the computation. A response
  /// then has Status::interrupted, and the values of break_away and break_away_bias are meaningless. Empty: never.
  void stop_with(std::function<bool()> stop);

  /// Steps of the integrator taken since the object was made, those of break_away and break_away_bias included.
  long steps() const;

  struct Solver;

 private:
  std::unique_ptr<Solver> solver_;
};

}  // namespace limcycle
