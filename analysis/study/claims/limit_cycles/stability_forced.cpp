#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/study/claims/limit_cycles/limit_cycles.hpp"
#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle::cycle_claims {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using std::numbers::pi;

/// Duffing's oscillator x'' + damping x' + x + cubic x^3 = force sin(w t).
struct Duffing {
  double damping = 0.1, cubic = 0.2, force = 0.4, w = 1.35;
  double period() const { return 2.0 * pi / w; }
  std::string text() const { return at({{"damping", damping}, {"cubic", cubic}, {"force", force}, {"w|rad/s", w}}); }
};

/// Amplitudes of the first-harmonic balance ((1 - w^2 + 3/4 cubic A^2)^2 + (damping w)^2) A^2 = force^2.
std::vector<double> balanced_amplitudes(const Duffing& o) {
  const auto excess = [&](double A) {
    const double stiffness = 1.0 - o.w * o.w + 0.75 * o.cubic * A * A;
    return std::hypot(stiffness, o.damping * o.w) * A - o.force;
  };
  return zeros_on_grid(excess, 1e-3, 30.0, 400);
}

Vector2d balanced_state(const Duffing& o, double A) {
  const double phase = -std::atan2(o.damping * o.w, 1.0 - o.w * o.w + 0.75 * o.cubic * A * A);
  return {A * std::sin(phase), A * o.w * std::cos(phase)};
}

/// The state one period later and its derivative, by the Runge-Kutta method of order 4.
std::pair<Vector2d, Matrix2d> period_map(const Duffing& o, const Vector2d& from) {
  using State = Eigen::Matrix<double, 2, 3>;  // the state and the two columns of the derivative
  const auto rate = [&](double t, const State& s) {
    State out;
    out.row(0) = s.row(1);
    out.row(1) = -o.damping * s.row(1) - (1.0 + 3.0 * o.cubic * s(0, 0) * s(0, 0)) * s.row(0);
    out(1, 0) = -o.damping * s(1, 0) - s(0, 0) - o.cubic * std::pow(s(0, 0), 3) + o.force * std::sin(o.w * t);
    return out;
  };
  constexpr int steps = 2000;
  const double h = o.period() / steps;
  State s;
  s << from, Matrix2d::Identity();
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const State k1 = rate(t, s), k2 = rate(t + 0.5 * h, s + 0.5 * h * k1), k3 = rate(t + 0.5 * h, s + 0.5 * h * k2),
                k4 = rate(t + h, s + h * k3);
    s += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
  }
  return {s.col(0), s.rightCols<2>()};
}

/// The periodic motion near the balance, by Newton's method; nothing if it does not converge.
std::optional<Vector2d> periodic_state(const Duffing& o, Vector2d x) {
  for (int i = 0; i < 30; ++i) {
    const auto [end, map] = period_map(o, x);
    const Vector2d step = (Matrix2d::Identity() - map).partialPivLu().solve(end - x);
    x += step;
    if (!x.allFinite()) return std::nullopt;
    if (step.norm() < 1e-12) return x;
  }
  return std::nullopt;
}

/// States after each of some periods, by the library's simulation.
std::vector<Vector2d> simulated(const Duffing& o, const Vector2d& from, int periods, const ClaimOptions& options,
                                ClaimChecks& checks) {
  LoopParts parts;
  parts.plant = Mass{1.0, o.damping, 1.0};
  Cubic<double> cubic;
  cubic.coefficient = o.cubic;
  parts.element = cubic;
  SimulateOptions run_options;
  run_options.duration = periods * o.period();
  run_options.sample = o.period();
  run_options.initial = {{"y", from(0)}, {"v", from(1)}};
  run_options.force = Signal{.kind = Signal::Kind::sine, .value = o.force, .frequency = o.w};
  run_options.stepper = "fehlberg78";
  run_options.rtol = 1e-12;
  run_options.stop = options.stop;
  const Simulation run = simulate(build_loop(parts), run_options);
  if (run.status != Status::converged) checks.stop(run.status);
  std::vector<Vector2d> states;
  for (std::size_t i = 1; i < run.rows.size(); ++i) states.emplace_back(run.rows[i][1], run.rows[i][2]);
  return states;
}

/// Multipliers of the simulated motion by differences: two starts near the periodic one.
Matrix2d by_differences(const Duffing& o, const Vector2d& x, const ClaimOptions& options, ClaimChecks& checks) {
  constexpr double eps = 1e-5;
  Matrix2d map = Matrix2d::Constant(std::nan(""));
  for (int k = 0; k < 2; ++k) {
    const auto up = simulated(o, x + eps * Vector2d::Unit(k), 1, options, checks);
    const auto down = simulated(o, x - eps * Vector2d::Unit(k), 1, options, checks);
    if (!up.empty() && !down.empty()) map.col(k) = (up[0] - down[0]) / (2.0 * eps);
  }
  return map;
}

/// True if there was a periodic motion to test near the balance.
bool check_motion(const Duffing& o, double A, double bound, const ClaimOptions& options, ClaimChecks& checks) {
  const std::string where = o.text() + ", near " + at({{"A", A}});
  const auto x = periodic_state(o, balanced_state(o, A));
  if (!x) return false;
  const Matrix2d map = period_map(o, *x).second;
  checks.equal(where, "product of the multipliers", "", std::exp(-o.damping * o.period()), map.determinant(), 1e-9);
  const Matrix2d differences = by_differences(o, *x, options, checks);
  checks.equal(where, "sum of the multipliers", "", map.trace(), differences.trace(), 1e-6, 1.0);
  const double largest = eigenvalues(map).cwiseAbs().maxCoeff();
  const int periods = std::min(400, static_cast<int>(std::ceil(8.0 / std::abs(std::log(largest)))));
  constexpr double off = 1e-4;
  const auto states = simulated(o, *x + Vector2d(off, 0.3 * off), periods, options, checks);
  if (states.empty()) return true;
  const double distance = (states.back() - *x).norm() / off;
  checks.is_true(where, "the simulation settles down or leaves at all", distance < 0.1 || distance > 10.0);
  checks.equal(where, "a neighbour comes back", "", largest < bound ? 1.0 : 0.0, distance < 0.1 ? 1.0 : 0.0, 0.0, 1.0);
  return true;
}

/// Number of balances from which Newton's method finds no periodic motion.
int check_oscillator(const Duffing& o, double bound, const ClaimOptions& options, ClaimChecks& checks) {
  int without = 0;
  for (const double A : balanced_amplitudes(o)) without += check_motion(o, A, bound, options, checks) ? 0 : 1;
  return without;
}

}  // namespace

ClaimResult test_forced_smooth(const ClaimOptions& options, double bound) {
  ClaimChecks checks;
  const Duffing fixed;
  checks.equal(fixed.text(), "motions by harmonic balance", "", 3.0,
               static_cast<double>(balanced_amplitudes(fixed).size()), 0.0, 1.0);
  checks.equal(fixed.text(), "balances without a periodic motion", "", 0.0,
               check_oscillator(fixed, bound, options, checks), 0.0, 1.0);
  int without = 0;
  at_random(checks, options, "E2", 10, [&](RandomPoints& draw) {
    check_oscillator(
        {draw.between(0.05, 0.3), draw.log_between(0.05, 0.5), draw.log_between(0.1, 1.0), draw.between(1.1, 1.8)},
        bound, options, checks);
  });
  if (without == 0) return checks.result();
  return checks.result("no periodic motion was found from " + std::to_string(without) +
                       " of the random balances, which are not tested");
}

Claim forced_smooth_claim() {
  Claim claim;
  claim.id = "E2";
  claim.statement =
      "A periodic motion of a forced smooth oscillator, found by harmonic balance, is stable if and only if the "
      "multipliers of its monodromy matrix lie within the unit circle.";
  claim.formula = "stable iff all |multipliers| < 1";
  claim.source = "Floquet theory, textbook";
  claim.evidence = Evidence::derived;
  claim.range =
      "Duffing's oscillator x'' + c x' + x + b x^3 = f sin(w t) with one or three motions; random: c 0.05..0.3, b "
      "0.05..0.5, f 0.1..1, w 1.1..1.8 rad/s";
  claim.test =
      "Monodromy by variational equations (Runge-Kutta) on the motion that Newton's method finds from the balance; "
      "against it differences of simulations by another method, and what becomes of a neighbour. A balance from "
      "which Newton's method finds none is counted, not tested. At most 10 random oscillators.";
  claim.run = [](const ClaimOptions& options) { return test_forced_smooth(options); };
  return claim;
}

}  // namespace limcycle::cycle_claims
