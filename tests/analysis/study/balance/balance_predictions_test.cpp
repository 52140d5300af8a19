#include "limcycle/analysis/study/balance/balance_predictions.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

TEST_CASE("harmonic balance of a loaded servo with a limited command begins where the integrator holds the load") {
  // Loop 14 of seed 4242.
  LoopParts parts;
  parts.plant = Mass{10.898, 0.522318, 0.0};
  Pid controller = pid(24.4644, 5.6416, 31.6119);
  controller.tf = 0.0435698;
  controller.saturation = 66.2946;
  parts.controller = controller;
  parts.friction = coulomb(11.9796, 7.16664);
  parts.load = 1.04564;
  const Loop loop = build_loop(parts);
  const FirstHarmonicBalance balance(loop);
  Prediction root;
  root.amplitude = root.input_amplitude = 66.9548;
  root.frequency = 0.334771;
  const Eigen::VectorXd means = balance.mean_inputs(root.input_amplitude, root.frequency, 1e-9);
  REQUIRE(means.allFinite());
  CHECK(std::abs(means(0)) == Approx(1.04564));  // the command
  const PredictOptions options;
  CycleHunt hunt(loop, options, default_search_box(loop));
  const BalancePredictions found = balance_predictions({loop, loop, &balance, {root}, 1'000'000, {}}, hunt);
  REQUIRE_FALSE(found.predictions.empty());
  CHECK(found.predictions.front().frequency == Approx(0.307837).epsilon(0.01));  // of the exact cycle, to 0.01 %
}
