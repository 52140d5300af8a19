#include <cmath>
#include <numbers>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/study/claims/limit_cycles/limit_cycles.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/stribeck.hpp"

namespace limcycle::cycle_claims {
namespace {

using std::numbers::pi;

/// Of the speeds at which swings begin to grow: far below what they are compared to, and each digit costs a simulation.
constexpr double threshold_accuracy = 1e-7;

/// An oscillation about steady sliding, started with a small deviation.
struct Shaken {
  Loop loop;
  std::map<std::string, double> equilibrium;
  double frequency, displacement;
};

/// Logarithm of the factor by which v^2 + w^2 (y - y_e)^2 changes over `periods` periods; NaN if the run ends early.
double growth(const Shaken& shaken, int periods, const ClaimOptions& options) {
  SimulateOptions run_options;
  run_options.duration = 2.0 * pi / shaken.frequency * periods;
  run_options.sample = run_options.duration;
  run_options.initial = shaken.equilibrium;
  run_options.initial["y"] += shaken.displacement;
  run_options.rtol = 1e-10;
  run_options.stop = options.stop;
  const Simulation run = simulate(shaken.loop, run_options);
  if (run.status != Status::converged) return std::nan("");
  const double off = run.trace.y.back() - shaken.equilibrium.at("y"), before = shaken.displacement;
  return std::log(std::pow(run.trace.rate.back() / shaken.frequency, 2) + off * off) - 2.0 * std::log(std::abs(before));
}

// ---- Froude's pendulum with a Stribeck curve: the quasi-static threshold

struct Bench {
  FroudePendulum pendulum;
  Stribeck<double> law;
};

double total_damping(const Bench& bench, double shaft_speed, OfLevels quasi_static) {
  const double r = bench.pendulum.shaft_radius;
  return bench.pendulum.damping +
         r * r * quasi_static(bench.law.Fs, bench.law.Fc, bench.law.vs, bench.law.sigma2, r * shaft_speed);
}

Shaken shaken(const Bench& bench, double shaft_speed) {
  FroudePendulum p = bench.pendulum;
  p.shaft_speed = shaft_speed;
  LoopParts parts;
  parts.plant = p;
  parts.friction = bench.law;
  const double v = p.shaft_radius * shaft_speed, weight = p.mass * p.gravity * p.arm;
  const double angle = std::asin(p.shaft_radius * (bench.law.level(v) + bench.law.sigma2 * v) / weight);
  return {build_loop(parts), {{"y", angle}}, std::sqrt(weight * std::cos(angle) / p.inertia), 1e-6};
}

/// Every threshold in the range of speeds: two, one or none, depending on the damping.
void check_threshold(const Bench& bench, OfLevels quasi_static, const ClaimOptions& options, ClaimChecks& checks) {
  const auto& law = bench.law;
  const double r = bench.pendulum.shaft_radius;
  const std::string where =
      at({{"c|N m s", bench.pendulum.damping}, {"Fs|N", law.Fs}, {"Fc|N", law.Fc}, {"vs|m/s", law.vs}});
  const auto thresholds = zeros_on_grid([&](double speed) { return total_damping(bench, speed, quasi_static); },
                                        0.02 * law.vs / r, 5.0 * law.vs / r, 100);
  for (const double claimed : thresholds) {
    if (options.stop && options.stop()) return checks.stop(Status::interrupted);
    const auto grows = [&](double speed) { return growth(shaken(bench, speed), 30, options); };
    checks.equal(where, "shaft speed at which small swings begin to grow", "rad/s", claimed,
                 zero_between(grows, 0.97 * claimed, 1.03 * claimed, threshold_accuracy), 1e-4);
  }
}

Bench bench(double damping, double Fs, double Fc, double vs) {
  FroudePendulum p;
  p.mass = 5.0;
  p.arm = 0.2;
  p.inertia = 0.25;
  p.damping = damping;
  p.shaft_radius = 0.02;
  auto law = stribeck(Fs, Fc, vs);
  law.sigma2 = 1.0;
  return {p, law};
}

// ---- LuGre: the dynamic incremental damping

void check_incremental(const LuGre<double>& law, double v, double w, OfSliding dynamic, ClaimChecks& checks) {
  const std::string where = at({{"v|m/s", v}, {"w|rad/s", w}, {"sigma2|N s/m", law.sigma2}});
  DfOptions df;
  df.method = DfMethod::quadrature;
  df.accuracy = 1e-9;
  const auto shaken = describing_function(law, {2e-3 * v / w, w, v}, df);
  if (!shaken.answered()) return checks.stop(shaken.status);
  const double size = law.sigma2 + (law.Fs - law.Fc) / law.vs * 0.1;
  checks.equal(where, "incremental damping", "N s/m", dynamic(law, v, w).real(), shaken.gain.imag() / w, 2e-5, size);
}

/// Speed of the belt at which sliding on LuGre becomes stable: m w^2 = k - w Im D and Re D = 0 for the damping D.
std::optional<std::pair<double, double>> hopf(const LuGre<double>& law, double mass, double stiffness,
                                              OfSliding dynamic) {
  const auto frequency = [&](double v) {
    const double w0 = std::sqrt(stiffness / mass);
    return zero_between([&](double w) { return stiffness - mass * w * w - w * dynamic(law, v, w).imag(); }, 0.5 * w0,
                        2.0 * w0);
  };
  const auto speeds =
      zeros_on_grid([&](double v) { return dynamic(law, v, frequency(v)).real(); }, 1.5 * law.vs, 6.0 * law.vs, 40);
  if (speeds.size() != 1) return std::nullopt;
  return std::pair{speeds[0], frequency(speeds[0])};
}

/// `difference`: least relative error of the quasi-static speed.
void check_hopf(double stiffness, double difference, OfSliding dynamic, OfLevels quasi_static,
                const ClaimOptions& options, ClaimChecks& checks) {
  const auto law = lugre(1.5, 1.0, 0.4);
  const std::string where = "belt, m = 1 kg, " + at({{"k|N/m", stiffness}});
  const auto claimed = hopf(law, 1.0, stiffness, dynamic);
  checks.is_true(where, "there is one Hopf speed above the steepest part of the curve", claimed.has_value());
  if (!claimed) return;
  const auto [speed, w] = *claimed;
  const auto grows = [&, w = w](double v) {
    const double level = law.level(v);
    return growth({belt_loop(Belt{1.0, stiffness, 0.0, v}, law),
                   {{"y", (level + law.sigma2 * v) / stiffness}, {"z", -level / law.sigma0}},
                   w,
                   1e-3 * v / w},
                  60, options);
  };
  const double found = zero_between(grows, 0.97 * speed, 1.03 * speed, threshold_accuracy);
  checks.equal(where, "Hopf speed", "m/s", speed, found, 2e-5);
  const double rough = zero_between([&](double v) { return quasi_static(law.Fs, law.Fc, law.vs, law.sigma2, v); },
                                    1.5 * law.vs, 6.0 * law.vs);
  checks.at_least(where, "relative error of the quasi-static speed", "", difference, std::abs(rough / found - 1.0),
                  0.0);
}

void check_printed_damping(OfSliding dynamic, OfLevels quasi_static, ClaimChecks& checks) {
  const std::string where = "v = 2e-4 m/s, w = 30 rad/s";
  const auto law = lugre(1.5, 1.0, 0.0);
  checks.equal(where, "dynamic damping of the table", "N s/m", -39.0, dynamic(law, 2e-4, 30.0).real(), 0.5, 1.0);
  checks.equal(where, "quasi-static damping of the table", "N s/m", -192.0, quasi_static(1.5, 1.0, 1e-3, 0.0, 2e-4),
               0.5, 1.0);
}

}  // namespace

std::complex<double> dynamic_damping(const LuGre<double>& law, double v, double w) {
  const double g = law.level(v), slope = quasi_static_damping(law.Fs, law.Fc, law.vs, 0.0, v);
  const std::complex<double> jw(0.0, w);
  return law.sigma2 + (law.sigma0 + jw * law.sigma1) * (v * slope / g) / (jw + law.sigma0 * v / g);
}

double quasi_static_damping(double Fs, double Fc, double vs, double sigma2, double v) {
  return sigma2 - 2.0 * (Fs - Fc) * v / (vs * vs) * std::exp(-v * v / (vs * vs));
}

ClaimResult test_sliding(const ClaimOptions& options, OfSliding dynamic, OfLevels quasi_static) {
  ClaimChecks checks;
  check_threshold(bench(0.005, 17.0, 7.4, 0.1), quasi_static, options, checks);
  check_printed_damping(dynamic, quasi_static, checks);
  check_incremental(lugre(1.5, 1.0, 0.0), 2e-4, 30.0, dynamic, checks);
  check_hopf(1e4, 2e-4, dynamic, quasi_static, options, checks);
  check_hopf(1e6, 2e-3, dynamic, quasi_static, options, checks);
  at_random(checks, options, "B10", 20, [&](RandomPoints& draw) {
    const double v = draw.log_between(5e-5, 3e-3), w = draw.log_between(1.0, 1000.0);
    check_incremental(lugre(1.5, 1.0, draw.between(0.0, 1.0)), v, w, dynamic, checks);
  });
  at_random(checks, options, "B10 of the pendulum", 5, [&](RandomPoints& draw) {
    const double Fc = draw.between(5.0, 10.0);
    check_threshold(bench(draw.between(0.002, 0.01), Fc * draw.between(1.8, 2.5), Fc, draw.log_between(0.05, 0.2)),
                    quasi_static, options, checks);
  });
  return checks.result();
}

std::vector<Claim> sliding_claims() {
  Claim claim;
  claim.id = "B10";
  claim.statement =
      "Sliding of a Froude pendulum becomes unstable where the total damping c + r^2 dF/dv at the speed of the "
      "shaft's surface changes its sign. With LuGre the incremental damping at the frequency of the oscillation "
      "takes the place of the slope of the steady curve, and the Hopf speed of a belt needs it.";
  claim.formula =
      "c + r^2 F'(r Omega) = 0; LuGre: Re[sigma2 + (sigma0 + j w sigma1)(v g'/g)/(j w + sigma0 v/g)], at v = 2e-4 "
      "m/s, w = 30 rad/s -39 N s/m, not -192";
  claim.source = "derived; checked by computation";
  claim.evidence = Evidence::derived;
  claim.range =
      "Gaussian Stribeck curve; pendulum of cases/froude-pendulum.toml with a law without bristles, random c "
      "0.002..0.01 N m s, Fc 5..10 N, Fs/Fc 1.8..2.5, vs 0.05..0.2 m/s; LuGre of 1995, random v 0.05..3 vs, w "
      "1..1000 rad/s, sigma2 0..1; belt with k = 1e4 and 1e6 N/m, where w is high enough for the difference to show";
  claim.test =
      "Root of the growth of small swings over 30 periods (pendulum) and 60 (belt) in simulations, against the "
      "formula's; first harmonic of the force under a prescribed velocity with a ripple of 0.2 %. At most 5 random "
      "pendulums.";
  claim.run = [](const ClaimOptions& options) { return test_sliding(options); };
  return {claim};
}

}  // namespace limcycle::cycle_claims
