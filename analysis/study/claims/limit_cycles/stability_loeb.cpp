#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"
#include "limcycle/analysis/study/balance/orbit_guess.hpp"
#include "limcycle/analysis/study/claims/limit_cycles/limit_cycles.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"

namespace limcycle::cycle_claims {
namespace {

using std::numbers::pi;

/// A relay with dead zone followed by 1/(s^3 + a2 s^2 + a1 s + a0), a2 a1 > a0 > 0.
struct RelayLoop {
  double a2, a1, a0, level = 1.0, dead_zone = 0.0;

  std::complex<double> inverse(double w) const {
    const std::complex<double> s(0.0, w);
    return ((s + a2) * s + a1) * s + a0;
  }
  double gain(double A) const { return 4.0 * level / (pi * A) * std::sqrt(1.0 - std::pow(dead_zone / A, 2)); }
  std::complex<double> characteristic(double A, double w) const { return inverse(w) + gain(A); }
  std::string text() const {
    return "relay on 1/(s^3 + a2 s^2 + a1 s + a0), " +
           at({{"a2", a2}, {"a1", a1}, {"a0", a0}, {"level", level}, {"dead zone", dead_zone}});
  }
  double frequency() const { return std::sqrt(a1); }
  /// Roots of gain(A) = a2 a1 - a0: one, or a small and a large one.
  std::vector<double> amplitudes() const {
    const double scale = 4.0 * level / (pi * (a2 * a1 - a0));
    if (dead_zone == 0.0) return {scale};
    const double d = dead_zone / scale, root = std::sqrt(1.0 - 4.0 * d * d);
    return {scale * std::sqrt(0.5 * (1.0 - root)), scale * std::sqrt(0.5 * (1.0 + root))};
  }
};

/// U_A V_w - U_w V_A of the characteristic function U + j V, by central differences.
double loeb(const RelayLoop& relay, double A, double w) {
  const double dA = 1e-6 * A, dw = 1e-6 * w;
  const auto by_A = (relay.characteristic(A + dA, w) - relay.characteristic(A - dA, w)) / (2.0 * dA);
  const auto by_w = (relay.characteristic(A, w + dw) - relay.characteristic(A, w - dw)) / (2.0 * dw);
  return by_A.real() * by_w.imag() - by_w.real() * by_A.imag();
}

/// The true cycle near a root, within a factor of exp(0.4), stable or not; otherwise a status. A root just beyond the
/// dead zone is a poor start for Newton's method: larger amplitudes are tried after it.
ShootingResult cycle_near(const Loop& loop, double A, double w, const ClaimOptions& options) {
  const FirstHarmonicBalance balance(loop);
  ShootingOptions shooting;
  shooting.stop = options.stop;
  ShootingResult shot;
  for (const double larger : {1.0, 1.03, 1.06, 1.1}) {
    const auto states = [&](double phase) { return balance.linear_state(larger * A, w, phase); };
    shot = shoot_multiple(loop, guess_orbit(loop, states, w, true), shooting);
    if (shot.status == Status::interrupted) break;
    if (shot.status == Status::converged && std::abs(std::log(shot.cycle.amplitude / A)) < 0.4) return shot;
  }
  if (shot.status == Status::converged) shot.status = Status::stalled;  // at another cycle
  return shot;
}

/// True if there was a cycle to test.
bool check_cycle(const RelayLoop& relay, double A, double orientation, const ClaimOptions& options,
                 ClaimChecks& checks) {
  const std::string where = relay.text() + ", near " + at({{"A", A}});
  Relay<double> element;
  element.level = relay.level;
  element.dead_zone = relay.dead_zone;
  const Loop loop = forward_loop(element, {1.0}, {1.0, relay.a2, relay.a1, relay.a0});
  const auto shot = cycle_near(loop, A, relay.frequency(), options);
  if (shot.status == Status::interrupted) checks.stop(shot.status);
  if (shot.status != Status::converged || !shot.cycle.stable) return false;
  checks.equal(where, "stable", "", orientation * loeb(relay, A, relay.frequency()) > 0.0 ? 1.0 : 0.0,
               *shot.cycle.stable ? 1.0 : 0.0, 0.0, 1.0);
  return true;
}

/// 1/(s+1)^3: with 1/G + N the derivatives are U_A = -4/(pi A^2), V_w = 3 - 3 w^2 = -6, U_w V_A = 0.
void check_example(double orientation, const ClaimOptions& options, ClaimChecks& checks) {
  const RelayLoop relay{3.0, 3.0, 1.0};
  const double A = 0.5 / pi, w = std::sqrt(3.0);
  checks.equal(relay.text(), "root of the describing function", "", 0.0, std::abs(relay.characteristic(A, w)), 1e-12,
               1.0);
  checks.equal(relay.text(), "U_A V_w - U_w V_A", "", 24.0 / (pi * A * A), loeb(relay, A, w), 1e-8);
  checks.is_true(relay.text(), "there is a cycle near the root", check_cycle(relay, A, orientation, options, checks));
}

}  // namespace

ClaimResult test_loeb(const ClaimOptions& options, double orientation) {
  ClaimChecks checks;
  check_example(orientation, options, checks);
  int tested = 0, untested = 0;
  at_random(checks, options, "E4", 20, [&](RandomPoints& draw) {
    const double a = draw.log_between(0.3, 3.0), w = draw.log_between(0.3, 3.0), zeta = draw.between(0.3, 1.5);
    RelayLoop relay{a + 2.0 * zeta * w, w * w + 2.0 * zeta * w * a, a * w * w, draw.log_between(0.1, 10.0)};
    const double scale = relay.amplitudes()[0];
    if (draw.share() < 0.7) relay.dead_zone = scale * draw.between(0.15, 0.42);  // at 0.5 the two roots meet
    for (const double A : relay.amplitudes())
      (check_cycle(relay, A, orientation, options, checks) ? tested : untested) += 1;
  });
  if (untested == 0) return checks.result();
  return checks.result("near " + std::to_string(untested) + " of " + std::to_string(tested + untested) +
                       " random roots no cycle was found, and nothing is said of them");
}

Claim loeb_claim() {
  Claim claim;
  claim.id = "E4";
  claim.statement =
      "Loeb's rule: a cycle that the describing function predicts is stable where the characteristic function U + j "
      "V turns one way, as long as the other closed-loop roots are stable. Heuristic: valid where the describing "
      "function itself is.";
  claim.formula = "stable if (dU/dA)(dV/dw) - (dU/dw)(dV/dA) > 0";
  claim.source = "J. M. Loeb (1956), from textbooks; sign derived; 1/(s+1)^3 checked against the exact map";
  claim.evidence = Evidence::derived;
  claim.range =
      "relay on third-order plants, with and without dead zone, where the third closed-loop root is -a2; random: "
      "plants as in B1, dead zone 0.15..0.42 of 4 level/(pi (a2 a1 - a0)), where the two roots meet at 0.5. Only "
      "roots with a cycle near them: some small ones, which hardly reach beyond the dead zone, have none that "
      "Newton's method finds";
  claim.test =
      "Multipliers of the true cycle near each root, stable or not, by multiple shooting (amplitude within a factor "
      "of 1.5); the finding counts the roots where none was found; the rule by differences of the characteristic "
      "function.";
  claim.run = [](const ClaimOptions& options) { return test_loeb(options); };
  return claim;
}

}  // namespace limcycle::cycle_claims
