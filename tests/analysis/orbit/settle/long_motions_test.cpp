#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/orbit/settle/displaced.hpp"
#include "limcycle/analysis/orbit/settle/growth.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/models/friction/bristle/elasto_plastic.hpp"
#include "limcycle/models/friction/bristle/two_state.hpp"
#include "limcycle/models/friction/dry/stribeck.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

Settled from(const Loop& loop, double displacement, double floor) {
  SettleOptions options;
  options.amplitude_floor = floor;
  return settle(loop, displaced(loop, displacement), options);
}

}  // namespace

TEST_CASE("settle: a load that rings while the motor sticks hunts with the period of the motor") {
  const Loop loop = loop_of(TwoMass{364000.0, 261036.0, 323210.0, 10656.9, {0}, {1}}, pid(18925.1, 480.725, 215246.0),
                            coulomb(220.329, 200.436));
  const Settled settled = from(loop, 0.003395, 1e-8);
  REQUIRE(settled.outcome == Outcome::cycle);
  // Found by an independent event-driven simulation; ringing crosses the section twice on each side.
  CHECK(settled.shot->cycle.period == Approx(1210.8298).epsilon(1e-7));
  CHECK(settled.shot->cycle.amplitude == Approx(0.00158162).epsilon(1e-5));
  CHECK(settled.shot->cycle.stable == true);
}

TEST_CASE("shooting: an even number of half maps is a map of the whole period, not of half of it") {
  const Loop loop = servo(coulomb(1.5, 1.0));
  const Settled settled = from(loop, 0.5, 1e-9);
  REQUIRE(settled.shot);
  const Cycle& cycle = settled.shot->cycle;
  ShootingOptions options;
  options.returns = 2;
  const auto twice = shoot(loop, cycle.start, choose_section(loop, cycle.trace), true, options);
  REQUIRE(twice.status == Status::converged);
  CHECK(twice.cycle.period == Approx(2.0 * cycle.period).epsilon(1e-9));
  CHECK_FALSE(twice.cycle.half_wave_symmetric);
}

TEST_CASE("settle: the finer the drop of friction, the finer and the slower the hunting") {
  // The slip is linear in the drop Fs - Fc, so that the amplitude is proportional to it, and the waits between slips
  // are 2 Fs/(ki amplitude) each, but for a constant. Both from an independent simulation at a drop of 0.02737 N.
  constexpr double Fs = 7.72737, drop = 0.02737, amplitude = 5.0688934648e-5, period = 134.2007307066;
  Pid controller = pid(276.045, 4537.75, 4.43241);
  controller.lag = 0.000329559;
  const auto waits = [&](double of) { return 4.0 * Fs / (controller.ki * of); };
  for (const double finer : {1.0, 1e-2}) {
    const Loop loop = loop_of(Mass{0.027473, 0.0, 0.0}, controller, coulomb(Fs, Fs - finer * drop));
    for (const double start : {0.1, 0.9}) {  // of the amplitude; from afar it may creep up to the set-point
      const Settled settled = from(loop, start * finer * amplitude, 1e-12);
      CAPTURE(finer, start, settled.why);
      REQUIRE(settled.outcome == Outcome::cycle);
      const Cycle& cycle = settled.shot->cycle;
      CHECK(cycle.amplitude == Approx(finer * amplitude).epsilon(1e-6));
      CHECK(cycle.period == Approx(waits(finer * amplitude) + period - waits(amplitude)).epsilon(1e-7));
      CHECK(cycle.stable == true);
    }
  }
}

TEST_CASE("settle: a bristle that rings for long while the controller winds up does not use up the step limit") {
  ElastoPlastic<double> law;
  law.Fc = law.Fc_minus = law.Fs = law.Fs_minus = 0.0100165;
  law.vs = 118.312;
  law.sigma0 = 3.24942;
  Pid controller = pid(0.00024906, 0.0230542, 3.85146e-07);
  controller.lag = 8.66066e-05;
  CHECK(from(loop_of(Mass{2.99456e-10, 0.0, 0.0}, controller, law), 0.1233, 1e-4).outcome == Outcome::rest);
}

TEST_CASE("settle: a limited servo diverges from afar as it does from nearby") {
  Stribeck<double> law;
  law.Fc = law.Fc_minus = 1.40491;
  law.Fs = law.Fs_minus = 2.39885;
  law.sigma2 = 0.017355;
  law.vs = 1.30454;
  Pid controller = pid(136.949, 19998.4, 0.28443);
  controller.saturation = 8.25144;
  const Loop loop = loop_of(Mass{0.00016836, 0.0025536, 0.0}, controller, law);
  for (const double start : {42.78, 427.8}) CHECK(from(loop, start, 1e-6).outcome == Outcome::divergence);
}

TEST_CASE("growth: without bound from afar, and none towards a bound or a cycle") {
  const auto grows = [](auto size) {
    TurningPoints turning;
    for (int n = 0; n < 400; ++n) {
      turning.feed(3.0 * n, size(n) * (n % 2 == 0 ? 1.0 : -1.0));
      turning.feed(3.0 * n + 1.0, 0.99 * size(n) * (n % 2 == 0 ? 1.0 : -1.0));
    }
    return grows_like_a_power(turning);
  };
  CHECK(grows([](int n) { return std::sqrt(1.0 + n); }));
  CHECK(grows([](int n) { return std::sqrt(300.0 + n); }));
  CHECK(grows([](int n) { return 1.0 + std::pow(n, 1.0 / 3.0); }));
  CHECK_FALSE(grows([](int n) { return 2.0 - std::exp(-0.02 * n); }));
  CHECK_FALSE(grows([](int n) { return 1.0 + std::log1p(n); }));
  CHECK_FALSE(grows([](int) { return 1.0; }));
  CHECK_FALSE(grows([](int n) { return 1.0 / (1.0 + n); }));
}

TEST_CASE(
    "settle: a body that creeps to the point where its forces balance comes to rest, and makes no cycle of roundings") {
  // Too strong a compensation drives it on with level - Fc until the spring of the controller balances that: it arrives
  // after infinite time, and nothing but roundings would turn it.
  for (const double unit : {1.0, 1e-3}) {  // of length, with the forces unchanged
    for (const double kp : {20.0, 9.0, 8.0}) {
      Pid controller = pid(kp / unit, 0.0, 10.0 / unit);
      controller.friction_compensation = 1.3;
      controller.lag = 0.05;
      const Settled settled =
          from(loop_of(Mass{1.0 / unit, 0.0, 0.0}, controller, coulomb(1.0, 1.0)), unit, 1e-9 * unit);
      INFO("kp = " << kp << ", unit = " << unit);
      CHECK(settled.outcome == Outcome::rest);
      CHECK(std::abs(settled.trace.y.back()) == Approx(0.3 * unit / kp).epsilon(1e-6));
    }
  }
}

TEST_CASE("settle: a body that trembles in loops too small for its return points has come to rest, in two units") {
  for (const double unit : {1.0, 1e3}) {  // of length: m, mm
    TwoState<double> law;
    law.Fc = law.Fc_minus = 1.0;
    law.Fs = law.Fs_minus = 1.5;
    law.vs = 1e-3 * unit;
    law.s = 1e-3 * unit;
    law.tau = 2e-3;
    law.sigma2 = 0.4 / unit;
    const Loop loop = loop_of(Mass{1.0 / unit, 0.0, 0.0}, pid(3.0 / unit, 0.0, 6.0 / unit), law);
    const double start = 1.5e-3 * unit;
    const Settled settled = from(loop, start, 1e-9 * unit);
    CAPTURE(unit, settled.why);
    CHECK(settled.outcome == Outcome::rest);
    CHECK(settled.trace.t.size() < 30'000);  // the step limit is 240,000
    // Friction holds it where the spring of the controller, 3 N/m, meets pre-sliding.
    CHECK(settled.trace.y.back() == Approx(start).epsilon(1e-3));
  }
}

TEST_CASE("a body that sticks for seconds while its bristle rings at 300 Hz: its swings are told from the rings") {
  // Loop 5 of seed 90210 of tests/random_loops. The first swing is fast, so that every ring once counted as a turn.
  auto law = with_levels<ElastoPlastic<double>>(86.4234, 55.2095);
  law.vs = 0.00267951;
  law.sigma0 = 8.33781e7;
  Pid controller = pid(15901.7, 56130.5, 697.193);
  controller.tf = 0.00167203;
  const Loop loop = loop_of(Mass{23.5079, 113.265, 0.0}, controller, Element(law));
  SettleOptions options;
  options.amplitude_floor = 1.699e-8;
  options.amplitude_ceiling = 170.0;
  options.fewest_turns = 8;
  const auto settled = settle(loop, displaced(loop, 0.001699), options);
  REQUIRE(settled.outcome == Outcome::cycle);
  CHECK(settled.shot->cycle.period == Approx(4.8312).epsilon(1e-4));
  CHECK(settled.shot->cycle.amplitude == Approx(0.0010933).epsilon(1e-4));
  CHECK(settled.steps < 150000);
}

TEST_CASE(
    "settle: a servo that creeps to the set-point with ever less speed comes to rest, and is not stopped on the way") {
  // The rate of the integral balances the decay: v/y and the approach are those of the slow pole, for ever. The
  // interpolant of a long step once had the body stop at 1e-11 m, from where the controller wound up for 17 years.
  for (const double unit : {1.0, 1e-3}) {        // of length
    for (const double times : {1.0, 7.62208}) {  // unit of time, with the forces unchanged
      const double length = 0.3 * unit;
      Pid controller = pid(9102.74 / unit, 4169.98 / (unit * times), 2382.13 * times / unit);
      controller.lag = 0.00554725 * times;
      controller.saturation = 45.7951;
      Loop loop = loop_of(Mass{159.847 * times * times / unit, 0.0, 0.0}, controller, coulomb(31.4064, 13.0978));
      for (const double start : {1.0, 0.01}) {
        const Settled settled = from(loop, start * length, 1e-9 * unit);
        CAPTURE(unit, times, start, settled.why);
        CHECK(settled.outcome == Outcome::rest);
        CHECK(settled.trace.t.back() < 1e3 * times);
      }
    }
  }
}
