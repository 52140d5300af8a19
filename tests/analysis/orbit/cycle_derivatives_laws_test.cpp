#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/models/friction/bristle/elasto_plastic.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/bristle/non_drift.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/models/friction/dry/karnopp.hpp"
#include "limcycle/models/friction/dry/stribeck.hpp"
#include "limcycle/models/friction/sliders/gms.hpp"
#include "limcycle/tests/cycle_knobs.hpp"
#include "limcycle/tests/friction_samples.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using namespace limcycle::test;

TEST_CASE("derivatives of the hunting LuGre servo by all its numbers, against differences of its cycle") {
  const auto parts = servo_parts(lugre());
  const auto knobs = lugre_knobs();
  const auto found = derived(parts, knobs);
  check_differences(parts, knobs, found);
  for (const auto& one : found.by) {
    CHECK(one.period_error < 1e-5 * std::abs(one.period));
    REQUIRE(one.multipliers.size() == 3);
    REQUIRE(one.multipliers[0].has_value());
    CHECK_FALSE(one.multipliers[1].has_value());  // below rounding
    CHECK(std::abs(one.multipliers[0]->imag()) < 1e-9 * std::abs(*one.multipliers[0]));
  }
}

TEST_CASE("derivatives through break-away and exact sticking: the Coulomb servo, period, amplitude and multiplier") {
  const auto parts = servo_parts(coulomb(1.5, 1.0, 0.4));
  auto knobs = and_levels<Coulomb<double>>(servo_knobs());
  knobs.push_back(of_law("sigma2", &Coulomb<double>::sigma2));
  const auto found = derived(parts, knobs);
  check_differences(parts, knobs, found, 1e-7);
  for (std::size_t k = 0; k < knobs.size(); ++k) {
    CAPTURE(knobs[k].name);
    const double expected = differences(parts, knobs[k], found.cycle).multiplier;
    CHECK(std::abs(found.by[k].multipliers[0].value() - expected) < 3e-6 * std::abs(expected) + 1e-9);
    CHECK_FALSE(found.by[k].multipliers[1].has_value());
  }
}

TEST_CASE("derivatives with other laws: Stribeck, Karnopp, elasto-plastic, GMS, and a belt that moves the kink") {
  auto karnopp = with_levels<Karnopp<double>>(1.5, 1.0);
  karnopp.vs = 1e-2;
  karnopp.dv = 1e-3;
  karnopp.sigma2 = 0.4;
  auto elastic = with_levels<ElastoPlastic<double>>(1.5, 1.0);
  elastic.vs = 1e-3;
  elastic.sigma0 = 1e5;
  elastic.sigma1 = 300.0;
  elastic.sigma2 = 0.4;
  auto gms = with_levels<Gms<double>>(1.5, 1.0);
  gms.vs = 1e-2;
  gms.k = {1e4, 5e3};
  gms.alpha = {0.5, 0.5};
  gms.C = 50.0;
  gms.sigma1 = {10.0, 10.0};
  gms.sigma2 = 0.4;
  int number = 0;
  const auto check_servo = [&](const LoopParts& parts, const std::vector<Knob>& knobs, double displacement) {
    if (!is_done(number++)) return;
    const auto found = derived(parts, knobs, displacement);
    check_differences(parts, knobs, found);
  };
  check_servo(servo_parts(stribeck(1.5, 1.0, 0.01)), and_levels<Stribeck<double>>(servo_knobs()), 1.0);
  check_servo(servo_parts(karnopp), and_levels<Karnopp<double>>(servo_knobs()), 1.0);
  check_servo(servo_parts(elastic), and_levels<ElastoPlastic<double>>({servo_knobs()[0], servo_knobs()[1]}), 1.0);
  check_servo(servo_parts(gms), and_levels<Gms<double>>({servo_knobs()[1]}), 1.0);
  check_servo(belt_parts(lugre()), and_levels<LuGre<double>>({belt_knobs()[0], belt_knobs()[1]}), 0.0);
  const auto parts = belt_parts(lugre());
  const std::vector<Knob> speed{belt_knobs()[2]};
  const auto found = derived(parts, speed, 0.0);
  check_differences(parts, speed, found, 5e-5);  // the amplitude all but ignores the speed
  CHECK(found.by[0].period_error < 5e-6 * std::abs(found.by[0].period));
}

TEST_CASE("derivatives of a cycle that remembers are refused: another history, another cycle") {
  const auto parts = servo_parts(made<NonDrift<double>>({{"Fs", 1.5},
                                                         {"Fc", 1.0},
                                                         {"vs", 1e-3},
                                                         {"Zb", 1e-3},
                                                         {"sigma", std::sqrt(1e5)},
                                                         {"tau", 2e-3},
                                                         {"sigma2", 0.4}}));
  const Loop loop = build_loop(parts);
  const Cycle cycle = the_cycle(loop, 0.1);
  REQUIRE(cycle.remembered > 0);
  const auto found = cycle_derivatives(loop, cycle, neighbours(parts, {servo_knobs()[0]}));
  CHECK(found.status == Status::undefined);
  CHECK(found.by.empty());
  CHECK_FALSE(found.why.empty());
}
