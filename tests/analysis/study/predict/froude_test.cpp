#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>

#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"
#include "limcycle/analysis/study/experiments/runs/froude.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/element/memoryless/gravity.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

using Complex = std::complex<double>;

LuGre<double> friction(double sigma0, double sigma1) {
  auto law = lugre(17.0, 7.4, 1.0);
  law.vs = 0.1;
  law.sigma0 = sigma0;
  law.sigma1 = sigma1;
  return law;
}

/// Dynamic damping of LuGre friction sliding at v, at s (claim B10).
Complex incremental(const LuGre<double>& law, double v, Complex s) {
  const double step = 1e-6 * v, g = law.level(v), slope = (law.level(v + step) - law.level(v - step)) / (2.0 * step);
  return law.sigma2 + (law.sigma0 + s * law.sigma1) * (v * slope / g) / (s + law.sigma0 * v / g);
}

/// The shaft's speed at which damping + radius^2 Re[...] = 0 at the frequency of the swing, and that frequency.
struct Onset {
  double speed, frequency, angle;
};
Onset onset(const LuGre<double>& law, double low, double high) {
  const FroudePendulum p = froude_pendulum(0.0);
  const double weight = p.mass * p.gravity * p.arm, r = p.shaft_radius;
  Onset found{};
  for (int i = 0; i < 60; ++i) {
    found.speed = 0.5 * (low + high);
    const double v = r * found.speed;
    found.angle = std::asin(r * (law.level(v) + law.sigma2 * v) / weight);
    found.frequency = std::sqrt(weight / p.inertia);
    for (int k = 0; k < 100; ++k) {
      const double lag = incremental(law, v, Complex(0.0, found.frequency)).imag();
      found.frequency = std::sqrt((weight * std::cos(found.angle) - r * r * found.frequency * lag) / p.inertia);
    }
    const double damping = p.damping + r * r * incremental(law, v, Complex(0.0, found.frequency)).real();
    (damping < 0.0 ? low : high) = found.speed;
  }
  return found;
}

/// Growth rate of small swings about steady sliding, 1/s, from the extremes of two stretches of a simulation.
double growth(const LuGre<double>& law, const Onset& at, double speed) {
  const Loop loop = build_loop(parts_of(froude_pendulum(speed), law));
  const double v = 0.02 * speed;
  SimulateOptions options;
  options.duration = 60.0;
  options.sample = 2e-3;
  options.rtol = 1e-10;
  options.initial = {{"y", at.angle + 1e-4}, {"v", 0.0}, {"z", -law.level(v) / law.sigma0}};
  const Simulation run = simulate(loop, options);
  REQUIRE(run.status == Status::converged);
  const auto y = static_cast<std::size_t>(std::ranges::find(run.columns, "y") - run.columns.begin());
  const double period = 2.0 * M_PI / at.frequency;
  const auto swing = [&](double from) {
    double low = infinite, high = -infinite;
    for (const auto& row : run.rows)
      if (row[0] >= from && row[0] < from + 2.0 * period) {
        low = std::min(low, row[y]);
        high = std::max(high, row[y]);
      }
    return high - low;
  };
  return std::log(swing(50.0) / swing(10.0)) / 40.0;
}

}  // namespace

TEST_CASE("Froude pendulum: self-excitation begins where the dynamic damping vanishes") {
  // A stiff bristle, whose damping is the slope of the Stribeck curve, and one so soft that it lags behind the swing.
  std::vector<double> speeds;
  for (const double sigma0 : {1e5, 300.0}) {
    const auto law = friction(sigma0, sigma0 > 1e4 ? 100.0 : 0.0);
    const Onset at = onset(law, 7.0, 20.0);
    speeds.push_back(at.speed);
    const double below = growth(law, at, 0.99 * at.speed), above = growth(law, at, 1.01 * at.speed);
    CAPTURE(sigma0, at.speed, at.frequency, below, above);
    CHECK(below > 0.0);
    CHECK(above < 0.0);
    const double crossing = at.speed * (0.99 + 0.02 * below / (below - above));
    CHECK(crossing == Approx(at.speed).epsilon(1e-3));
  }
  CHECK(std::abs(speeds[1] / speeds[0] - 1.0) > 0.01);  // the quasi-static rule would miss it
}

TEST_CASE("Froude pendulum: every start leads to the one swing, which the describing function confirms") {
  const Loop loop = build_loop(parts_of(froude_pendulum(4.0), friction(1e5, 100.0)));
  CHECK_FALSE(FirstHarmonicBalance::not_applicable(loop));
  PredictOptions options;
  options.search = SearchBox{5e-3, 0.03, 5.0, 8.0};
  const PredictReport report = predict(loop, options);
  REQUIRE(report.cycles.size() == 1);
  const Cycle& cycle = report.cycles[0];
  CHECK(cycle.stable == true);
  bool confirmed = false;
  for (const Prediction& p : report.predictions)
    if (p.method == "describing-function" && p.verdict == Verdict::confirmed) confirmed = true;
  CHECK(confirmed);
  for (const auto& outcome : report.outcomes) CHECK(outcome.outcome == Outcome::cycle);
  // The work of the shaft equals the loss in friction and damping: mean torque of friction times the speed of the
  // swing.
  CHECK(cycle.offset > 0.0);
  CHECK(cycle.amplitude == Approx(0.66).epsilon(0.05));
}

TEST_CASE("Froude pendulum: the balance of gravity and friction is solved by its own oscillation") {
  // N of both and the mean angle substituted: J (jw)^2 + c jw + N_gravity + radius^2 N_friction = 0.
  const Loop loop = build_loop(parts_of(froude_pendulum(4.0), friction(1e5, 100.0)));
  const FirstHarmonicBalance balance(loop);
  const double A = 0.0125, w = 6.1, angle = A / 0.02;
  const Complex N = balance.gain(A, w, 1e-9), s(0.0, w);
  const auto& gravity = law_of<Gravity<double>>(loop.elements[0]);
  const Eigen::VectorXd means = balance.mean_inputs(A, w, 1e-9);
  const Complex G = *gravity.exact_describing_function(angle, w, means(0));
  const Complex expected = 1.0 + (G + 4e-4 * N) / (0.25 * s * s + 0.005 * s);
  CHECK(std::abs(balance(A, w, 1e-9) - expected) < 1e-9 * std::abs(expected));
  CHECK(means(0) > 0.0);
}

TEST_CASE("Froude pendulum: with play, friction that does not fall leaves the swing alone") {
  auto settings = froude_settings();
  REQUIRE(settings.size() == 4);
  settings.resize(1);
  settings[0].duration = 4.0;
  settings[0].left_out = 1.5;
  const FroudeResult result = froude_experiment(settings, {1e-4}, 1);
  REQUIRE(result.status == Status::converged);
  const FroudeComparison& with = result.series[0].clearances[1];
  CHECK(with.run.losses == 0);
  CHECK(std::abs(with.swing_change) < 2e-3);
  CHECK(with.angle_change < 0.01);
  CHECK(with.run.energy_error < 1e-6);
  CHECK(with.fast_rubbing > 100.0 * result.series[0].clearances[0].fast_rubbing);
  CHECK(result.series[0].finding.find("never leaves the shaft") != std::string::npos);
}
