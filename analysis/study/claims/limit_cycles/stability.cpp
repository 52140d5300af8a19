#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "limcycle/analysis/study/claims/limit_cycles/limit_cycles.hpp"
#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace cycle_claims {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

double log_product(const Cycle& cycle) {
  double sum = 0.0;
  for (const auto& multiplier : cycle.multipliers) sum += std::log(std::abs(multiplier));
  return sum;
}

/// Van der Pol's oscillator: the trace mu (1 - x^2) changes along the cycle.
void check_van_der_pol(double mu, double share, const ClaimOptions& options, ClaimChecks& checks) {
  const std::string where = at({{"mu", mu}});
  const auto shot = reached_cycle(van_der_pol(mu), 1.0, where, options, checks);
  if (!shot) return;
  const double trace = along(
      shot->cycle, [mu](double x) { return mu * (1.0 - x * x); }, [mu](double x) { return -2.0 * mu * x; });
  checks.equal(where, "ln of the product of the multipliers", "", share * trace, log_product(shot->cycle), 1e-6);
  checks.equal(where, "trivial multiplier", "", 1.0, 1.0 + shot->trivial_error, 1e-6);
}

/// The same followed by a lag, mu s/((s^2 - mu s + 1)(tau s + 1)): the cubic does not act on its own rate, so that the
/// trace is mu - 1/tau everywhere.
void check_lagged(double mu, double tau, double share, const ClaimOptions& options, ClaimChecks& checks) {
  const std::string where = at({{"mu", mu}, {"tau|s", tau}});
  Cubic<double> cubic;
  cubic.coefficient = 1.0 / 3.0;
  const Loop loop = forward_loop(cubic, {mu, 0.0}, {tau, 1.0 - mu * tau, tau - mu, 1.0});
  const auto shot = reached_cycle(loop, 1.0, where, options, checks);
  if (!shot) return;
  checks.equal(where, "multipliers beside the trivial one", "", 2.0,
               static_cast<double>(shot->cycle.multipliers.size()), 0.0, 1.0);
  checks.equal(where, "ln of the product of the multipliers", "", share * (mu - 1.0 / tau) * shot->cycle.period,
               log_product(shot->cycle), 1e-6);
  checks.equal(where, "trivial multiplier", "", 1.0, 1.0 + shot->trivial_error, 1e-6);
}

// ---- E3

/// Derivative of the half map of a hunting servo (states e, de/dt, integral of e) from break-away to break-away.
Matrix3d half_map(const Servo& servo, const Coulomb<double>& friction, const HuntingCycle& cycle, bool at_break_away) {
  Matrix3d slip, stick;
  slip << 0.0, 1.0, 0.0, -servo.kp / servo.mass, -(servo.kd + friction.sigma2) / servo.mass, -servo.ki / servo.mass,
      1.0, 0.0, 0.0;
  stick << 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0;
  Matrix3d entering = Matrix3d::Identity();
  entering(1, 1) = 0.0;  // f+ is tangent to v = 0
  Matrix3d leaving = Matrix3d::Identity();
  const Eigen::RowVector3d normal(servo.kp, servo.kd, servo.ki);
  const Vector3d jump(0.0, -(friction.Fs - friction.Fc) / servo.mass, 0.0);
  if (at_break_away) leaving += jump * normal / (servo.ki * cycle.amplitude);
  return -leaving * Matrix3d(exponential(stick * cycle.stick)) * entering * Matrix3d(exponential(slip * cycle.slip));
}

/// Eigenvalues by size, largest first.
std::vector<double> moduli(const Eigen::MatrixXd& map) {
  std::vector<double> out;
  const Eigen::VectorXcd values = eigenvalues(map);
  for (const auto& value : values) out.push_back(std::abs(value));
  std::ranges::sort(out, std::greater{});
  return out;
}

void check_servo(const Servo& servo, const Coulomb<double>& friction, bool at_break_away, const ClaimOptions& options,
                 ClaimChecks& checks) {
  const std::string where =
      servo.text() + ", " + at({{"Fs|N", friction.Fs}, {"Fc|N", friction.Fc}, {"sigma2|N s/m", friction.sigma2}});
  const auto built = hunting_cycle(servo, friction);
  checks.is_true(where, "the servo hunts", built.has_value());
  if (!built) return;
  const Matrix3d map = half_map(servo, friction, *built, at_break_away);
  const auto of_map = moduli(map);
  checks.equal(where, "trivial eigenvalue of the half map", "", 1.0, of_map[0], 1e-8);
  checks.equal(where, "eigenvalue of the half map that sticking makes zero, over the size of the map", "", 0.0,
               of_map[2] / map.norm(), 1e-10, 1.0);
  const auto shot = reached_cycle(servo_loop(servo, friction), 1.5 * built->amplitude, where, options, checks);
  if (!shot || shot->cycle.multipliers.size() != 2) return;
  checks.equal(where, "multiplier of the period", "", of_map[1] * of_map[1], std::abs(shot->cycle.multipliers[0]), 1e-7,
               1.0);
  checks.equal(where, "multiplier of sticking", "", 0.0, std::abs(shot->cycle.multipliers[1]), 0.0, 1.0);
}

void check_printed_saltation(bool at_break_away, ClaimChecks& checks) {
  const std::string where = "the servo of B7, Fs = 1.5 N, Fc = 1 N, sigma2 = 0.4 N s/m";
  const auto friction = coulomb(1.5, 1.0, 0.4);
  const auto built = hunting_cycle({}, friction);
  checks.is_true(where, "the servo hunts", built.has_value());
  if (!built) return;
  const auto with = moduli(half_map({}, friction, *built, at_break_away));
  checks.equal(where, "second eigenvalue with saltation at break-away", "", 0.0975, with[1], 1e-4, 1.0);
  const auto without = moduli(half_map({}, friction, *built, false));
  checks.equal(where, "first eigenvalue without it", "", 4.91, without[0], 5e-3, 1.0);
  checks.equal(where, "second eigenvalue without it", "", 0.076, without[1], 5e-4, 1.0);
}

void check_relay(double a, double w, double zeta, const ClaimOptions& options, ClaimChecks& checks) {
  const std::string where = "relay, 1/((s + a)(s^2 + 2 zeta w s + w^2)), " + at({{"a", a}, {"w", w}, {"zeta", zeta}});
  Relay<double> relay;
  relay.level = 1.0;
  const Loop loop = forward_loop(relay, {1.0}, {1.0, a + 2.0 * zeta * w, w * w + 2.0 * zeta * w * a, a * w * w});
  const auto shot = reached_cycle(loop, 1.0, where, options, checks);
  if (!shot) return;
  const auto exact = relay_cycles(relay_feedback(loop, 1.0), 0.1 * shot->cycle.period, 2.0 * shot->cycle.period);
  checks.is_true(where, "there is one exact cycle", exact.size() == 1);
  if (exact.size() != 1) return;
  const auto of_map = moduli(exact[0].W);
  checks.equal(where, "smallest eigenvalue of W", "", 0.0, of_map.back(), 1e-10, 1.0);
  checks.equal(where, "multipliers beside the trivial one", "", static_cast<double>(of_map.size() - 1),
               static_cast<double>(shot->cycle.multipliers.size()), 0.0, 1.0);
  for (std::size_t i = 0; i < std::min(shot->cycle.multipliers.size(), of_map.size() - 1); ++i)
    checks.equal(where, "multiplier of the period", "", of_map[i] * of_map[i], std::abs(shot->cycle.multipliers[i]),
                 1e-8, 1.0);
}

}  // namespace

ClaimResult test_smooth_multipliers(const ClaimOptions& options, double share_of_trace) {
  ClaimChecks checks;
  for (const double mu : {0.1, 0.5, 1.0, 2.0}) check_van_der_pol(mu, share_of_trace, options, checks);
  check_lagged(1.0, 0.3, share_of_trace, options, checks);
  at_random(checks, options, "E1", 20, [&](RandomPoints& draw) {
    const double mu = draw.log_between(0.3, 2.0);
    check_lagged(mu, draw.log_between(0.1, 0.4), share_of_trace, options, checks);
  });
  return checks.result();
}

ClaimResult test_saltation(const ClaimOptions& options, bool at_break_away) {
  ClaimChecks checks;
  check_printed_saltation(at_break_away, checks);
  check_servo({}, coulomb(1.5, 1.0, 0.4), at_break_away, options, checks);
  check_relay(1.0, 1.0, 1.0, options, checks);
  at_random(checks, options, "E3", 20, [&](RandomPoints& draw) {
    const Servo servo = stabilising_servo(draw);
    const double Fc = draw.log_between(0.3, 3.0);
    check_servo(servo, coulomb(Fc * draw.between(1.1, 2.0), Fc, draw.between(0.0, 0.3) * servo.kd), at_break_away,
                options, checks);
  });
  at_random(checks, options, "E3 of relays", 10, [&](RandomPoints& draw) {
    const double a = draw.log_between(0.3, 3.0), w = draw.log_between(0.3, 3.0);
    check_relay(a, w, draw.between(0.3, 1.5), options, checks);
  });
  return checks.result();
}

namespace {

Claim smooth_claim() {
  Claim claim;
  claim.id = "E1";
  claim.statement =
      "A smooth autonomous cycle has one multiplier 1, and the product of all is exp of the integral of the trace.";
  claim.formula = "product of the multipliers = exp(integral of tr J over a period)";
  claim.source = "Liouville's formula, textbook; derived";
  claim.evidence = Evidence::derived;
  claim.range =
      "smooth elements; van der Pol with mu 0.1..2, and with a lag behind it (two multipliers), random mu 0.3..2, "
      "tau 0.1..0.4";
  claim.test =
      "Multipliers from the product of the derivatives of all steps of the period; the integral along the cycle, or "
      "exactly where the trace is constant.";
  claim.run = [](const ClaimOptions& options) { return test_smooth_multipliers(options); };
  return claim;
}

Claim saltation_claim() {
  Claim claim;
  claim.id = "E3";
  claim.statement =
      "At a switch small deviations are multiplied by a saltation matrix; entering stick it makes one multiplier "
      "exactly zero, at break-away with Fs > Fc it is needed too, and a relay's half map has one zero eigenvalue.";
  claim.formula =
      "S = I + (f+ - f-) n'/(n' f-); half map of B7 (sigma2 = 0.4): {1, 0.0975, 0} with, {4.91, 0.076, 0} without "
      "the one at break-away";
  claim.source = "derived; checked by computation";
  claim.evidence = Evidence::derived;
  claim.range = "transversal switches; random: servos and levels as in B7-3, relays as in B1";
  claim.test =
      "Half map from the exact construction and its matrix exponentials against the multipliers that shooting finds "
      "on the whole loop; {1, 0.0975, 0} by its trivial eigenvalue, which a wrong matrix does not have. At most 10 "
      "relays.";
  claim.run = [](const ClaimOptions& options) { return test_saltation(options); };
  return claim;
}

}  // namespace

std::vector<Claim> smooth_stability_claims() { return {smooth_claim(), saltation_claim()}; }

}  // namespace cycle_claims

std::vector<Claim> stability_claims() {
  auto of_autonomous = cycle_claims::smooth_stability_claims();  // E1, E3
  return {of_autonomous[0], cycle_claims::forced_smooth_claim(), of_autonomous[1], cycle_claims::loeb_claim()};
}

}  // namespace limcycle
