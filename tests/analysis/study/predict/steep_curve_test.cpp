#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/study/predict/cycle_search.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// A drive in N, m, s whose measured Stribeck curve begins with infinite slope, under PID with a filtered derivative.
Loop drive(double delta) {
  auto law = stribeck(820.333, 330.341, 2.15214);
  law.delta = delta;
  LoopParts parts;
  parts.plant = Mass{0.0326939, 0.0, 0.0};
  Pid controller = pid(1133.85, 19998.2, 8.43127);
  controller.tf = 0.000327048;
  parts.controller = controller;
  parts.friction = law;
  return build_loop(parts);
}

/// A heavy axis whose period is that of the slow pole of the plant. Its return map has no derivative.
Loop heavy_axis() {
  auto law = stribeck(15254.9, 8966.79, 0.0133765);
  law.delta = 0.5;
  law.sigma2 = 6479.21;
  LoopParts parts;
  parts.plant = Mass{9583.77, 249.971, 0.0};
  Pid controller = pid(39471.7, 15606.9, 18762.5);
  controller.saturation = 48193.8;
  parts.controller = controller;
  parts.friction = law;
  return build_loop(parts);
}

/// A light servo in any writing of its mass and damping.
Loop light_servo(const Plant& plant) {
  auto law = stribeck(0.0508683, 0.0283739, 2.18192);
  law.delta = 0.5;
  law.sigma2 = 2.2323e-6;
  LoopParts parts;
  parts.plant = plant;
  Pid controller = pid(0.00702758, 0.0832342, 9.9759e-5);
  controller.saturation = 0.231044;
  parts.controller = controller;
  parts.friction = law;
  return build_loop(parts);
}

}  // namespace

TEST_CASE(
    "stribeck: hunting on a curve with infinite slope at rest is a stable cycle, also where no multiplier tells") {
  struct {
    Loop loop;
    double start, other_start, duration;
  } const hunting[] = {
      {drive(0.5), 0.2, 0.4, 20.0}, {drive(0.8), 0.2, 0.4, 20.0}, {heavy_axis(), 0.1484, 14.84, 3000.0}};
  for (const auto& [loop, start, other_start, duration] : hunting) {
    const SettleOptions options = cycle_search(loop, default_search_box(loop), 1e-8);
    const Settled found = settle(loop, displaced(loop, start), options);
    REQUIRE(found.outcome == Outcome::cycle);
    REQUIRE(found.shot);
    CHECK(found.shot->cycle.stable == true);
    // A long run by another stepper, from another start, at another tolerance.
    SimulateOptions run;
    run.stepper = "fehlberg78";
    run.rtol = 1e-9;
    run.duration = duration;
    run.initial = {{"y", other_start}};
    const Simulation simulated = simulate(loop, run);
    REQUIRE(simulated.outcome == Outcome::cycle);
    const double periods = simulated.period / found.shot->cycle.period;
    CHECK(periods == Approx(std::round(periods)).epsilon(2e-4));
    CHECK(simulated.amplitude == Approx(found.shot->cycle.amplitude).epsilon(2e-4));
  }
}

TEST_CASE("stribeck: a body that slides off ever faster is not stopped at the instant of break-away, in any writing") {
  const double mass = 6.24834e-7, damping = 8.54125e-7;
  for (const Plant& plant : {Plant(Mass{mass, damping, 0.0}),
                             Plant(TransferFunction{{1600425.072899362}, {1.0, 1.3669630653901674, 0.0}, 0.0})}) {
    const Loop loop = light_servo(plant);
    const SettleOptions options = cycle_search(loop, default_search_box(loop), 1e-8);
    for (const double start : {3.974, 397.4}) {
      INFO(start);
      const Settled found = settle(loop, displaced(loop, start), options);
      REQUIRE(found.outcome == Outcome::cycle);
      REQUIRE(found.shot);
      CHECK(found.shot->cycle.period == Approx(1.2323262).epsilon(1e-6));
    }
  }
}

TEST_CASE("steep curve: on a belt without damping every slip begins from the same state, so there is one cycle") {
  // The velocity of the body is that of the belt while it sticks. Relative to that, an error is a whole start of slip:
  // three cycles were found, with periods of 49.336 s, 49.338 s and 148.008 s.
  for (const double unit : {1.0, 1e3}) {
    LoopParts parts;
    parts.plant = Belt{837115.0 * unit, 23456.2 * unit, 0.0, 0.00285178};
    auto law = test::stribeck(7915.4 * unit, 7115.55 * unit, 0.000476006);
    law.delta = 0.5;
    parts.friction = law;
    PredictOptions options;
    options.methods = {false, false, false};
    const auto report = predict(build_loop(parts), options);
    REQUIRE(report.cycles.size() == 1);
    const Cycle& cycle = report.cycles.front();
    // From SciPy's DOP853 at 1e-12 in the square root of the rubbing velocity, from break-away to stick.
    CHECK(cycle.period == Approx(49.3360393).epsilon(1e-7));
    CHECK(cycle.error < 1e-7);
  }
}

TEST_CASE(
    "stribeck: the multiplier of a mass that sticks to its belt is zero, whatever the slope of the curve at rest") {
  // While it sticks only its place is free, and that is a shift in time: nothing of a deviation is left.
  for (const double delta : {0.5, 1.0, 2.0}) {
    auto law = stribeck(12.1865, 7.08891, 7.11449e-4);
    law.delta = delta;
    INFO("delta " << delta);
    const PredictReport report = predict(loop_of(Belt{0.857457, 734.132, 0.0, 0.0825526}, NoController{}, law));
    REQUIRE(report.cycles.size() == 1);
    const Cycle& cycle = report.cycles.front();
    CHECK(cycle.stable == true);
    REQUIRE(cycle.multipliers.size() == 1);
    CHECK(std::abs(cycle.multipliers.front()) < 1e-10);
    CHECK(cycle.multiplier_error < 1e-6);
  }
}
