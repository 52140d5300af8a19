#include "limcycle/analysis/orbit/cycle/agreement.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Catch::Matchers::Contains;

namespace {

Loop stiff_servo(double sigma0) {
  auto law = lugre();
  law.sigma0 = sigma0;
  law.sigma1 = std::sqrt(sigma0);
  return servo(law);
}

SimulateOptions from_one(double duration, double rtol = 1e-7) {
  SimulateOptions options;
  options.duration = duration;
  options.initial["y"] = 1.0;
  options.rtol = rtol;
  return options;
}

}  // namespace

TEST_CASE("agreement: default tolerances agree at every stiffness, cycle and motion alike") {
  for (const double sigma0 : {1e4, 1e5, 1e6, 1e8}) {
    const Loop loop = stiff_servo(sigma0);
    const auto options = from_one(200.0);
    const auto run = simulate(loop, options);
    const auto second = agreement(loop, options, run);
    INFO("sigma0 = " << sigma0 << ": " << second.why);
    CHECK(second.agrees);
    CHECK(second.verdict_agrees);
    CHECK(second.rtol == Approx(1e-9));
    REQUIRE(run.outcome == Outcome::cycle);
    CHECK(second.period_difference < 1e-6);
    CHECK(second.amplitude_difference < 1e-6);
    CHECK(second.position_difference < 1e-5);
    CHECK(second.phase_drift < 1e-4);
    CHECK(second.phase_drift > 0.0);
    CHECK(std::isnan(second.parted));
  }
}

TEST_CASE("agreement: period of a run against its known value") {
  const auto run = simulate(stiff_servo(1e5), from_one(200.0));
  CHECK(run.outcome == Outcome::cycle);
  CHECK(run.period == Approx(24.436786456).epsilon(1e-4));
  CHECK(run.trace.t.size() == static_cast<std::size_t>(run.steps) + 1);
}

TEST_CASE("agreement: false hunting of a rough run is reported, with when it parts or by how much") {
  const Loop loop = stiff_servo(1e8);  // T = 23.73296 s; at rtol = 1e-2 stiction breaks early
  const auto options = from_one(200.0, 1e-2);
  const auto run = simulate(loop, options);
  REQUIRE(std::abs(run.period / 23.73296 - 1.0) > 0.01);
  const auto second = agreement(loop, options, run);
  CHECK_FALSE(second.agrees);
  CHECK(second.rtol <= 1e-4);
  CHECK_FALSE(second.why.empty());
}

TEST_CASE("agreement: two rough runs that err alike are not taken for two that agree") {
  const Loop loop = stiff_servo(1e8);
  const auto options = from_one(200.0, 0.1);
  const auto run = simulate(loop, options);
  CHECK(agreement(loop, options, run, 1e-3).position_difference < alike);  // both hunt falsely
  CHECK_FALSE(agreement(loop, options, run).agrees);
}

TEST_CASE("agreement: long steps do not count as a difference of the motions") {
  LoopParts parts;
  parts.plant = Belt{1.0, 100.0, 0.1, 0.05};
  parts.friction = stribeck(1.0, 0.6, 0.1);
  const Loop loop = build_loop(parts);
  for (const double rtol : {1e-5, 1e-7, 1e-9}) {
    SimulateOptions options;
    options.duration = 2.0;
    options.sample = 0.5;
    options.rtol = rtol;
    const auto second = agreement(loop, options, simulate(loop, options));
    CAPTURE(rtol);
    CHECK(second.agrees);
    CHECK(second.position_difference < 1e-4);
    CHECK(second.phase_drift < 2e-5);
  }
}

TEST_CASE("agreement: a drift in phase is told, and is no disagreement") {
  const Loop loop = stiff_servo(1e3);  // approaches its cycle slowly: the phase drifts for long
  const auto options = from_one(400.0, 1e-2);
  const auto run = simulate(loop, options);
  const auto second = agreement(loop, options, run);
  CHECK(second.agrees);
  CHECK(second.phase_drift > 1e-2);
  CHECK(second.phase_drift < 1.0);
  CHECK(second.position_difference < alike);
}

TEST_CASE("agreement: nearly double precision is compared with a looser run, no motion agrees with itself") {
  CHECK(other_tolerance(1e-12) == Approx(1e-10));
  CHECK(other_tolerance(1e-9) == Approx(1e-11));
  CHECK(other_tolerance(0.1) == Approx(1e-7));
  auto options = from_one(10.0);
  options.initial["y"] = 0.0;
  const Loop loop = stiff_servo(1e5);
  const auto still = simulate(loop, options);
  const auto second = agreement(loop, options, still);
  CHECK(second.agrees);
  CHECK(second.position_difference == 0.0);
  CHECK(std::isnan(second.period_difference));
}

TEST_CASE("agreement: an interrupted second run says so and agrees with nothing") {
  const Loop loop = stiff_servo(1e5);
  auto options = from_one(30.0);
  const auto run = simulate(loop, options);
  options.stop = [asked = 0]() mutable { return ++asked > 50; };
  const auto second = agreement(loop, options, run);
  CHECK(second.status == Status::interrupted);
  CHECK_FALSE(second.agrees);
  CHECK_THAT(second.why, Contains("interrupted"));
}

TEST_CASE("agreement: runs that a signal drives have no outcome of their own, but are compared") {
  LoopParts parts;
  parts.plant = Mass{1.0, 0.0, 0.0};
  parts.controller = pid(3.0, 0.0, 1.0);
  parts.friction = lugre();
  const Loop loop = build_loop(parts);
  SimulateOptions options;
  options.duration = 40.0;
  options.force = Signal{.kind = Signal::Kind::sine, .value = 3.0, .frequency = 1.0};
  const auto run = simulate(loop, options);
  CHECK(run.outcome == Outcome::undecided);
  const auto second = agreement(loop, options, run);
  CHECK(second.agrees);
  CHECK(second.position_difference > 0.0);
  CHECK(second.position_difference < 1e-4);
}
