#include "limcycle/analysis/energy/loop/rubbing_impedance.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/models/laws.hpp"
#include "limcycle/tests/friction_samples.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

Loop controlled(Plant plant, Controller controller, Element friction = coulomb(1.5, 1.0)) {
  LoopParts parts;
  parts.plant = std::move(plant);
  parts.controller = std::move(controller);
  parts.friction = std::move(friction);
  return build_loop(parts);
}

TwoMass two_mass(double damping, int measured) {
  TwoMass plant;
  plant.motor_mass = 1.0;
  plant.load_mass = 0.5;
  plant.stiffness = 100.0;
  plant.damping = damping;
  plant.measured.index = measured;
  return plant;
}

/// Re Z(jw) from the response of the rubbing displacement, by complex arithmetic on the loop's own matrices.
double resistance_of(const Loop& loop, double w) {
  return (-1.0 / (std::complex<double>(0.0, w) * loop.element_response(w)(0, 0))).real();
}

}  // namespace

TEST_CASE("resistance that friction feels: PD, PID, filtered and lagged controllers in closed form") {
  const RubbingImpedance pd(servo(coulomb(1.5, 1.0)));
  REQUIRE(pd.applies().decision == Decision::yes);
  CHECK(pd.margin().value == -infinite);  // kd - ki/w^2
  CHECK(pd.resistance(2.0) == Approx(6.0 - 4.0 / 4.0).epsilon(1e-12));

  const RubbingImpedance no_integral(controlled(Mass{1.0, 0.25, 0.0}, pid(3.0, 0.0, 6.0)));
  CHECK(no_integral.margin().value == Approx(6.25).epsilon(1e-13));
  CHECK(no_integral.rest_is_passive().answer.decision == Decision::yes);
  CHECK(no_integral.no_cycle(6.25 - 1e-9).decision == Decision::yes);
  CHECK(no_integral.no_cycle(6.25 + 1e-9).decision == Decision::no);
  CHECK(no_integral.no_cycle(std::nan("")).decision == Decision::undecided);

  Pid filtered = pid(3.0, 0.0, 6.0);
  filtered.tf = 0.01;
  const RubbingImpedance with_filter(controlled(Mass{1.0, 0.0, 0.0}, filtered));  // kd/(1 + (w tf)^2): no more than > 0
  CHECK(with_filter.margin().value == 0.0);
  CHECK(std::isinf(with_filter.margin().frequency));
  CHECK(with_filter.no_cycle(0.0).decision == Decision::yes);
  CHECK(with_filter.no_cycle(1e-6).decision == Decision::no);

  // (kp + kd s)/(s (1 + T s)): Re = (kd - kp T)/(1 + (w T)^2): a lag of more than kd/kp undoes the damping.
  for (const double lag : {1.9, 2.1}) {
    Pid lagged = pid(3.0, 0.0, 6.0);
    lagged.lag = lag;
    const RubbingImpedance with_lag(controlled(Mass{1.0, 0.0, 0.0}, lagged));
    CHECK(with_lag.no_cycle(0.0).decision == (lag < 2.0 ? Decision::yes : Decision::no));
    CHECK(with_lag.margin().value == Approx(lag < 2.0 ? 0.0 : 6.0 - 3.0 * lag).epsilon(1e-9));
  }
}

TEST_CASE("resistance that friction feels: a rest without losses proves nothing") {
  const RubbingImpedance spring(controlled(Mass{1.0, 0.0, 2.0}, NoController{}));
  CHECK(spring.rest_is_passive().answer.decision == Decision::yes);
  CHECK(spring.margin().value == 0.0);
  CHECK(spring.no_cycle(0.0).decision == Decision::no);
  CHECK(spring.no_cycle(-0.4).decision == Decision::yes);  // sigma2 to spare
  // The load swings undamped while friction holds the motor: cycles for any friction that can stick.
  const RubbingImpedance undamped(controlled(two_mass(0.0, 0), pid(3.0, 0.0, 6.0)));
  CHECK(undamped.rest_is_passive().answer.decision == Decision::yes);
  CHECK(undamped.no_cycle(0.0).decision == Decision::no);
  CHECK(undamped.no_cycle(-1.0).decision == Decision::no);
  CHECK(RubbingImpedance(controlled(two_mass(0.1, 0), pid(3.0, 0.0, 6.0))).no_cycle(0.0).decision == Decision::yes);
}

TEST_CASE("resistance that friction feels: margins of random loops against sweeps of the complex response") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  int finite = 0;
  for (int trial = 0; trial < 20; ++trial) {
    Pid controller = pid(10.0 * part(random), 0.0, 6.0 * part(random));
    if (trial % 2) controller.lag = 0.2 * part(random);
    if (trial % 3) controller.tf = 0.2 * part(random);
    const Loop loop = controlled(two_mass(0.5 * part(random), trial % 2), controller);
    const RubbingImpedance impedance(loop);
    double swept = infinite, where = 0.0;
    for (int i = 0; i <= 24000; ++i) {
      const double w = std::pow(10.0, -3.0 + i / 3000.0), value = resistance_of(loop, w);
      if (value < swept) swept = value, where = w;
    }
    INFO("trial " << trial << ", sweep " << swept << " at " << where << ", margin " << impedance.margin().value);
    const double size = std::abs(swept) + 1.0;
    CHECK(impedance.resistance(where) == Approx(resistance_of(loop, where)).margin(1e-8 * size));
    CHECK(impedance.margin().value <= swept + 1e-8 * size);
    CHECK(impedance.margin().value >= swept - 1e-3 * size);
    finite += std::isfinite(impedance.margin().frequency) && impedance.margin().frequency > 0.0;
  }
  CHECK(finite >= 4);
}

TEST_CASE("absence by passivity says when it is not its business") {
  const auto decision = [](const Loop& loop) { return RubbingImpedance(loop).no_cycle(0.0).decision; };
  CHECK(decision(belt(coulomb(1.5, 1.0))) == Decision::not_applicable);
  CHECK(decision(build_loop(parts_of(froude_pendulum(4.0)))) == Decision::not_applicable);
  CHECK(decision(forward(relay(1.0), {1.0}, {1.0, 1.0})) == Decision::not_applicable);
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  parts.controller = pid(3.0, 0.0, 6.0);
  parts.reference_rate = 0.1;
  CHECK(decision(build_loop(parts)) == Decision::not_applicable);  // a ramp
  parts.reference_rate = 0.0;
  parts.reference = 0.7;
  parts.load = 0.3;
  CHECK(decision(build_loop(parts)) == Decision::yes);  // constant signals drop out where the position is held
  parts.controller = NoController{};
  CHECK(decision(build_loop(parts)) == Decision::not_applicable);  // here the load may drive a steady slide
  parts.load = 0.0;
  CHECK(decision(build_loop(parts)) == Decision::no);  // mass alone: a lossless rest
  parts.plant = Mass{1.0, 0.5, 0.0};
  CHECK(decision(build_loop(parts)) == Decision::yes);  // and a damped one
  TransferFunction late{{1.0}, {1.0, 1.0, 0.0}, 0.1};
  parts.plant = late;
  parts.controller = pid(1.0, 0.0, 1.0);
  CHECK(decision(build_loop(parts)) == Decision::undecided);  // a delay
  parts = servo_parts(coulomb(1.5, 1.0));
  parts.error = DeadZone<double>{};
  law_of<DeadZone<double>>(*parts.error).half_width = 0.1;
  CHECK(decision(build_loop(parts)) == Decision::not_applicable);
}

TEST_CASE(
    "absence by passivity agrees with what motions come to: every passive law under PD, and the servo that hunts") {
  int laws = 0;
  FrictionLaws::for_each([&]<template <class> class Kind>() {
    bool done = false;
    for_samples<Kind>([&](const auto& law, const Sample& sample) {
      if (!sample.passive || done) return;
      done = true;
      const Loop loop = controlled(Mass{1.0, 0.0, 0.0}, pid(3.0, 0.0, 6.0), law);
      INFO(law.kind << ", " << sample.name);
      CHECK(RubbingImpedance(loop).no_cycle(0.0).decision == Decision::yes);
      SettleOptions options;
      options.max_steps = 5000;
      const Settled settled = settle(loop, displaced(loop, 0.3), options);
      CHECK(settled.outcome != Outcome::cycle);
      CHECK(settled.outcome != Outcome::divergence);
      laws += settled.outcome == Outcome::rest;
    });
  });
  CHECK(laws >= 8);
  const Loop hunting = servo(lugre());
  CHECK(RubbingImpedance(hunting).no_cycle(0.0).decision == Decision::no);
  CHECK(settle(hunting, displaced(hunting, 0.3), {}).outcome == Outcome::cycle);
}

TEST_CASE("absence by passivity is never claimed where a motion hunts: random loops with a law that sticks") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  int proved = 0, hunts = 0;
  for (int trial = 0; trial < 24; ++trial) {
    Pid controller = pid(20.0 * part(random), trial % 2 ? 4.0 * part(random) : 0.0, 4.0 * part(random));
    controller.lag = trial % 3 ? 0.3 * part(random) : 0.0;
    const Plant plant = trial % 4 < 2 ? Plant(Mass{1.0, 0.0, 0.0}) : Plant(two_mass(0.3 * part(random), trial % 2));
    const Loop loop = controlled(plant, controller);
    const bool none = RubbingImpedance(loop).no_cycle(0.0).decision == Decision::yes;
    SettleOptions options;
    options.max_steps = 4000;
    const bool cycle = settle(loop, displaced(loop, 0.5), options).outcome == Outcome::cycle;
    INFO("trial " << trial);
    CHECK_FALSE((none && cycle));
    proved += none;
    hunts += cycle;
  }
  CHECK(proved >= 3);
  CHECK(hunts >= 3);
}
