/// Friction whose curve about rest is passed in next to no time: a step that is accurate for the state may pass over
/// it.
#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/orbit/cycle/return_map.hpp"
#include "limcycle/analysis/orbit/cycle/section_chart.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// A saturated servo in N, m, s: at its unstable cycle, of 0.1 s, the mass passes the Stribeck velocity in 2e-6 s.
Loop saturated_servo() {
  auto law = stribeck(0.44068, 0.20012, 0.0487937);
  law.sigma2 = 0.000549742;
  law.delta = 2.0;
  LoopParts parts;
  parts.plant = Mass{2.34265e-05, 0.00202878, 0.0};
  Pid controller = pid(28.2769, 4345.86, 0.0534713);
  controller.saturation = 0.761224;
  parts.controller = controller;
  parts.friction = law;
  return build_loop(parts);
}

/// The largest multiplier of a cycle, by central differences of its return map at a tight tolerance.
double largest_by_differences(const Loop& loop, const Cycle& cycle) {
  const Section section = choose_section(loop, cycle.trace);
  ReturnMap map(loop, section, std::nullopt, {1e-12, 1'000'000, {}});
  const auto on_section = map.approach(cycle.start);
  const auto image = map(on_section.state);
  REQUIRE(image.status == Status::converged);
  const SectionChart chart(section, image.largest, typical_sizes(loop));
  const Eigen::Index n = chart.basis.cols();
  constexpr double h = 1e-4;
  Eigen::MatrixXd derivative(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    LoopState up = on_section.state, down = up;
    up.x = chart.lift(on_section.state.x, h * Eigen::VectorXd::Unit(n, j));
    down.x = chart.lift(on_section.state.x, -h * Eigen::VectorXd::Unit(n, j));
    derivative.col(j) = chart.coordinates(map(up).state.x, map(down).state.x) / (2.0 * h);
  }
  return derivative.eigenvalues().cwiseAbs().maxCoeff();
}

const Cycle& cycle_of(const PredictReport& report, bool stable) {
  const auto found = std::ranges::find_if(report.cycles, [&](const Cycle& cycle) { return cycle.stable == stable; });
  REQUIRE(found != report.cycles.end());
  return *found;
}

}  // namespace

TEST_CASE(
    "thin layer: the unstable cycle of a saturated servo is found, and its multiplier is that of its return map") {
  const Loop loop = saturated_servo();
  const PredictReport report = predict(loop);
  const Cycle& unstable = cycle_of(report, false);
  REQUIRE_FALSE(unstable.multipliers.empty());
  CHECK(std::abs(unstable.multipliers.front()) == Approx(largest_by_differences(loop, unstable)).epsilon(1e-3));
  // Harmonic balance, which integrates nothing, finds it too.
  REQUIRE_FALSE(report.predictions.empty());
  CHECK(report.predictions.back().verdict == Verdict::confirmed);
}
