/// @file
/// Shared by the claims about limit cycles and their stability: random parameters, loops, the cycle that a loop
/// reaches, and the exact half-period map of relay feedback.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/study/claims/claim_points.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/friction/dry/stribeck.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle::cycle_claims {

/// Runs a test at min(options.random_points, most) random points, until it is stopped. They differ from those of other
/// claims.
void at_random(ClaimChecks& checks, const ClaimOptions& options, std::string_view id, int most,
               const std::function<void(RandomPoints&)>& test);

/// "m = 1 kg, k = 2 N/m"; the names bring their units: {"m|kg", 1.0}.
std::string at(std::initializer_list<std::pair<const char*, double>> values);

Coulomb<double> coulomb(double Fs, double Fc, double sigma2 = 0.0);
Stribeck<double> stribeck(double Fs, double Fc, double vs);
/// LuGre with the stiffness and damping of Canudas de Wit et al. (1995): sigma0 = 1e5, sigma1 = sqrt(1e5), vs = 1e-3.
LuGre<double> lugre(double Fs, double Fc, double sigma2);

/// Mass under PID control.
struct Servo {
  double mass = 1.0, kp = 3.0, ki = 4.0, kd = 6.0;  ///< those of Canudas de Wit et al. (1995)
  std::string text() const;
};
Loop servo_loop(const Servo& servo, Element friction);
/// Random gains that stabilise the mass: kd kp > mass ki with a margin of 1.2 to 4.
Servo stabilising_servo(RandomPoints& draw);

Loop belt_loop(const Belt& belt, Element friction);
/// An element in front of numerator/denominator exp(-delay s), in negative feedback.
Loop forward_loop(Element element, std::vector<double> numerator, std::vector<double> denominator, double delay = 0.0);
/// x'' - mu (1 - x^2) x' + x = 0 as a loop: mu s/(s^2 - mu s + 1) and the element x^3/3; y = x.
Loop van_der_pol(double mu);

/// Outcome from a displacement of y; swings below `floor` of it have died out.
Settled settled(const Loop& loop, double displacement, const ClaimOptions& options, double floor = 1e-7);
/// The shooting result of the cycle that is reached. Without one: a check that fails, or a status if the motion was not
/// decided.
std::optional<ShootingResult> reached_cycle(const Loop& loop, double displacement, const std::string& where,
                                            const ClaimOptions& options, ClaimChecks& checks);

/// Zero of a continuous function between two points where it has opposite signs, to a relative `accuracy` (algorithm
/// 748 of Alefeld, Potra and Shi 1995, Boost.Math); NaN if it has not.
double zero_between(const std::function<double(double)>& f, double low, double high, double accuracy = 4e-16);
/// All zeros that appear as a change of sign on a grid of `points` (logarithmic if low > 0).
std::vector<double> zeros_on_grid(const std::function<double(double)>& f, double low, double high, int points);

/// dx/dt = A x + B u, u = -level sgn(C x) with hysteresis: relay feedback, or Coulomb friction with C x the velocity.
struct RelayFeedback {
  Eigen::MatrixXd A;
  Eigen::VectorXd B;
  Eigen::RowVectorXd C;
  double level = 1.0, hysteresis = 0.0;

  /// Phi = exp(A h) and Gamma = (integral of exp(A s) over 0..h) B.
  std::pair<Eigen::MatrixXd, Eigen::VectorXd> over(double h) const;
};
/// The relay feedback equivalent to a loop with a relay, or with Coulomb friction alone.
RelayFeedback relay_feedback(const Loop& loop, double level, double hysteresis = 0.0);

/// C x at the end of half a period whose mirror image is the next half.
double switching_output(const RelayFeedback& relay, double h);
using SwitchingOutput = std::function<double(const RelayFeedback&, double)>;

/// A symmetric cycle of relay feedback by its exact condition.
struct RelayCycle {
  double half_period = 0.0;
  Eigen::VectorXd switching;                      ///< state at the switch from +level to -level
  Eigen::MatrixXd W;                              ///< derivative of the half-period map
  double peak = 0.0;                              ///< of |C x|
  std::vector<std::complex<double>> eigenvalues;  ///< of W, largest first
};
/// All cycles with half periods in a range that solve switching_output = hysteresis and do not switch earlier.
std::vector<RelayCycle> relay_cycles(const RelayFeedback& relay, double shortest, double longest,
                                     const SwitchingOutput& output = switching_output);

}  // namespace limcycle::cycle_claims
