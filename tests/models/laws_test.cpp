#include <catch2/catch.hpp>
#include <random>

#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/with_memory/backlash.hpp"
#include "limcycle/models/friction/bristle/dahl.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/laws.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// Odd elements: mirrored input, state and mode give the mirrored output and rate.
template <class E>
void check_odd(const E& element, std::vector<Mode> modes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const auto n = static_cast<std::size_t>(element.states());
  for (int i = 0; i < 200; ++i) {
    for (const Mode mode : modes) {
      const Input<double> in{u(random), 0.01 * u(random), u(random)}, mirrored{-in.x, -in.v, -in.drive};
      std::vector<double> z(n), minus_z(n), dz(n), minus_dz(n);
      for (std::size_t k = 0; k < n; ++k) minus_z[k] = -(z[k] = u(random) * element.state_scale(0));
      CHECK(element.output(in, mode, z) == Approx(-element.output(mirrored, element.mirror(mode), minus_z)));
      element.rate(in, mode, z, dz);
      element.rate(mirrored, element.mirror(mode), minus_z, minus_dz);
      for (std::size_t k = 0; k < n; ++k) CHECK(dz[k] == Approx(-minus_dz[k]));
    }
  }
}

}  // namespace

TEST_CASE("elements are odd where they say so") {
  check_odd(coulomb(1.5, 1.0, 0.3), {{-1}, {0}, {1}});
  check_odd(stribeck(1.5, 1.0, 1e-3), {{-1}, {0}, {1}});
  check_odd(lugre(), {{0}});
  check_odd(Dahl<double>{1.0, 1e5, 1.5}, {{0}});
  check_odd(relay(1.0, 0.2), {{-1}, {1}});
  check_odd(saturation(0.3), {{-1}, {0}, {1}});
  DeadZone<double> dead_zone;
  dead_zone.half_width = 0.2;
  check_odd(dead_zone, {{-1}, {0}, {1}});
  Backlash<double> backlash;
  backlash.half_gap = 0.2;
  check_odd(backlash, {{-1}, {0}, {1}});
  RateLimit<double> rate_limit;
  rate_limit.limit = 0.3;
  rate_limit.tau = 0.5;
  check_odd(rate_limit, {{-1}, {0}, {1}});
  ValveStiction<double> valve;
  valve.S = 0.3;
  valve.J = 0.1;
  check_odd(valve, {{-2}, {-1}, {1}, {2}});
  Lookup<double> table;
  table.inputs = {0.0, 0.2, 0.5};
  table.outputs = {0.0, 0.4, 0.3};
  check_odd(table, {{0}, {1}, {2}, {3}, {4}});
  HystereticDeadZone<double> zone;
  zone.half_width = 0.2;
  zone.hysteresis = 0.1;
  check_odd(zone, {{-1}, {0}, {1}});
  Impulses<double> impulses;
  impulses.force = 2.0;
  impulses.pause = 1.0;
  check_odd(impulses, {{-1}, {0}, {1}});  // else a clock runs, whose state is even
  StopResetIntegrator<double> stop_reset;
  stop_reset.gain = 2.0;
  stop_reset.speed = 0.005;
  check_odd(stop_reset, {{-1}, {0}, {1}});
  Cubic<double> cubic;
  cubic.coefficient = 2.0;
  check_odd(cubic, {{0}});
  Sine<double> sine;
  sine.amplitude = 2.0;
  check_odd(sine, {{0}});
  auto uneven = coulomb(1.5, 1.0);
  uneven.Fc_minus = 0.8;
  CHECK_FALSE(uneven.odd());
}

TEST_CASE("Stribeck curve: values of claim D1, limits, positivity") {
  const auto law = lugre();
  CHECK(law.level(0.5e-3) == Approx(1.389400).epsilon(1e-6));
  CHECK(law.level(1e-3) == Approx(1.183940).epsilon(1e-6));
  CHECK(law.level(2e-3) == Approx(1.009158).epsilon(1e-6));
  for (int curve = 0; curve < 3; ++curve) {
    auto shaped = law;
    shaped.curve.index = curve;
    CHECK(shaped.level(0.0) == Approx(1.5));
    CHECK(shaped.level(1e3) == Approx(1.0).epsilon(1e-9));
    for (double v = 1e-7; v < 10.0; v *= 1.7) {
      CHECK(shaped.level(v) == shaped.level(-v));
      CHECK(shaped.level(v) >= 1.0);
      CHECK(shaped.level(v) <= 1.5);
    }
  }
}

TEST_CASE("LuGre: steady state is the Stribeck curve, and |z| <= Fs/sigma0 is invariant") {
  const auto law = lugre();
  for (const double v : {1e-5, 1e-3, 0.1, -0.02}) {
    const double z[] = {law.level(v) * (v > 0 ? 1 : -1) / law.sigma0};
    double dz[1];
    law.rate({0.0, v, 0.0}, {}, z, dz);
    CHECK(std::abs(dz[0]) < 1e-15 * std::abs(v) + 1e-18);
    CHECK(law.output({0.0, v, 0.0}, {}, z) == Approx((v > 0 ? 1 : -1) * law.level(v) + law.sigma2 * v));
    const double edge[] = {law.Fs / law.sigma0};
    law.rate({0.0, v, 0.0}, {}, edge, dz);
    CHECK(dz[0] <= 0.0);  // claim D6: at the edge z does not grow
  }
}

TEST_CASE("LuGre with vd: sigma1 fades with speed") {
  auto law = lugre();
  law.vd = 1e-3;
  const double z[] = {0.0};
  CHECK(law.output({0.0, 1e-6, 0.0}, {}, z) == Approx(lugre().output({0.0, 1e-6, 0.0}, {}, z)).epsilon(1e-5));
  CHECK(law.output({0.0, 0.1, 0.0}, {}, z) == Approx(0.4 * 0.1));
}

TEST_CASE("Dahl: energy balance F v - d(F^2/2 sigma0)/dt = |v| F^2/Fc for exponent 1") {
  const Dahl<double> law{1.2, 1e5, 1.0};
  for (const double v : {1e-3, -2e-3})
    for (const double f : {-1.1, 0.3, 1.0}) {
      const double z[] = {f / law.sigma0};
      double dz[1];
      law.rate({0.0, v, 0.0}, {}, z, dz);
      CHECK(f * v - f * dz[0] == Approx(std::abs(v) * f * f / law.Fc));
    }
}

TEST_CASE("Dahl: sigma0 to infinity is Coulomb: full force after a displacement of many Fc/sigma0") {
  const Dahl<double> law{1.0, 1e9, 1.0};
  double z = 0.0, dz[1];
  for (int i = 0; i < 4000; ++i) {  // explicit Euler in displacement, 1e-11 m a step
    law.rate({0.0, 1.0, 0.0}, {}, std::span<const double>(&z, 1), dz);
    z += 1e-11 * dz[0];
  }
  CHECK(law.sigma0 * z == Approx(1.0).epsilon(1e-9));
}

TEST_CASE("stick and slip of set-valued laws") {
  const auto law = coulomb(1.5, 1.0);
  const Mode stuck{0}, forward{1}, backward{-1};
  std::vector<double> none;
  CHECK(law.next({0.0, 0.0, 1.4}, forward, none, 0) == stuck);
  CHECK(law.next({0.0, 0.0, 1.6}, backward, none, 0) == forward);
  CHECK(law.next({0.0, 0.0, -1.6}, forward, none, 0) == backward);
  CHECK(law.next({0.0, 0.0, -infinite}, forward, none, 0) == backward);
  CHECK(law.next({0.0, 0.0, 1.5}, stuck, none, 0) == forward);
  CHECK(law.next({0.0, 0.0, -1.5}, stuck, none, 1) == backward);
  CHECK(law.held(stuck) == Held::rate);
  CHECK(law.held(forward) == Held::nothing);
  CHECK(law.output({0.0, 0.0, 0.7}, stuck, none) == 0.7);
  CHECK(law.output({0.0, 0.2, 0.7}, forward, none) == 1.0);
  double g[2];
  law.guard({0.0, 0.0, 1.4}, stuck, none, g);
  CHECK(g[0] == Approx(0.1));
  CHECK(g[1] == Approx(2.9));
}

TEST_CASE("relay: thresholds, dead zone and sliding") {
  std::vector<double> none;
  double g[2];
  const auto wide = relay(1.0, 0.1, 0.5);
  wide.guard({0.55, 0.0, 0.0}, {0}, none, g);
  CHECK(g[0] == Approx(0.05));  // on at 0.6
  wide.guard({0.55, 0.0, 0.0}, {1}, none, g);
  CHECK(g[0] == Approx(0.15));  // off at 0.4
  CHECK(wide.next({0.6, 0.0, infinite}, {0}, none, 0) == Mode{1});
  CHECK(wide.next({0.4, 0.0, -infinite}, {1}, none, 0) == Mode{0});
  const auto ideal = relay(1.0);
  CHECK(ideal.next({0.0, 0.0, -infinite}, {1}, none, 0) == Mode{-1});
  CHECK(ideal.next({0.0, 0.0, 0.3}, {1}, none, 0) == Mode{2});
  CHECK(ideal.held({2}) == Held::input);
  CHECK(ideal.next({0.0, 0.0, -1.1}, {2}, none, 1) == Mode{-1});
  const auto sliding_up = relay(1.0, 0.0, 0.5);  // slides between 0 and +1 only
  CHECK(sliding_up.next({0.5, 0.0, -0.2}, {1}, none, 0) == Mode{0});
  CHECK(sliding_up.next({0.5, 0.0, 0.2}, {1}, none, 0) == Mode{2});
}

TEST_CASE("backlash remembers the output at which it was left") {
  Backlash<double> backlash;
  backlash.half_gap = 0.5;
  std::vector<double> z{0.0};
  CHECK(backlash.output({2.0, 1.0, 0.0}, {1}, z) == 1.5);
  CHECK(backlash.next({2.0, 0.0, 0.0}, {1}, z, 0) == Mode{0});
  CHECK(z[0] == 1.5);
  CHECK(backlash.output({1.7, -1.0, 0.0}, {0}, z) == 1.5);
  double g[2];
  backlash.guard({1.0, -1.0, 0.0}, {0}, z, g);
  CHECK(g[1] == Approx(0.0).margin(1e-15));  // picks up on the way down at x = 1
}

TEST_CASE("parameter tables: keys are unique, members differ, recast keeps values") {
  const auto check = []<template <class> class Kind>() {
    const auto table = Kind<double>::parameters();
    for (std::size_t i = 0; i < table.size(); ++i) {
      CHECK_FALSE(table[i].meaning.empty());
      CHECK_FALSE(table[i].unit.empty());
      for (std::size_t j = 0; j < i; ++j) {
        CHECK(table[i].key != table[j].key);
        CHECK(table[i].member != table[j].member);
      }
    }
    CHECK_FALSE(Kind<double>::equation.empty());
    CHECK_FALSE(Kind<double>::source.empty());
  };
  FrictionLaws::for_each(check);
  ForwardElements::for_each(check);
  ErrorElements::for_each(check);
  MadeElements::for_each(check);
  const auto copy = recast<LuGre, double>(lugre());
  CHECK(copy.sigma1 == lugre().sigma1);
  CHECK(copy.Fs_minus == 1.5);
}

TEST_CASE("closed forms of describing functions at the test points of the claims") {
  const auto at = [](const auto& e, double A, double w = 1.0, double b = 0.0) {
    return *e.exact_describing_function(A, w, b);
  };
  CHECK(at(relay(1.0), 2.0).real() == Approx(0.636620).margin(6e-7));
  CHECK(at(relay(1.0, 0.0, 0.5), 2.0).real() == Approx(0.616404).margin(6e-7));
  CHECK(at(relay(1.0, 0.5), 2.0).real() == Approx(0.616404).margin(6e-7));
  CHECK(at(relay(1.0, 0.5), 2.0).imag() == Approx(-0.159155).margin(6e-7));
  CHECK(at(saturation(0.5), 2.0).real() == Approx(0.314962).margin(6e-7));
  DeadZone<double> dead_zone;
  dead_zone.half_width = 0.5;
  CHECK(at(dead_zone, 2.0).real() == Approx(0.685038).margin(6e-7));
  Backlash<double> backlash;
  backlash.half_gap = 0.5;
  CHECK(at(backlash, 2.0).real() == Approx(0.804499).margin(6e-7));
  CHECK(at(backlash, 2.0).imag() == Approx(-0.238732).margin(6e-7));
  Cubic<double> cubic;
  cubic.coefficient = 1.0;
  CHECK(at(cubic, 2.0).real() == Approx(3.0));
  CHECK(at(coulomb(1.0, 1.0), 0.01).imag() == Approx(127.323954).epsilon(1e-8));
  CHECK(at(coulomb(1.0, 1.0), 1.0, 1.0, 0.3).imag() == Approx(1.214593).margin(6e-7));
}
