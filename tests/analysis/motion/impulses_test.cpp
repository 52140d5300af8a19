#include "limcycle/models/element/of_controllers/impulses.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/models/element/of_controllers/stop_reset_integrator.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;

namespace {

struct Units {
  double length = 1.0, time = 1.0, force = 1.0;
  double mass() const { return force * time * time / length; }
};

/// A body with Coulomb friction of level 1 that impulses of 3 alone push towards y = 0.
LoopParts pushed(const Units& unit) {
  LoopParts parts = test::servo_parts(test::coulomb(unit.force, unit.force));
  parts.plant = Mass{2.0 * unit.mass(), 0.0, 0.0};
  Pid controller = test::pid(0.0, 0.0, 0.0);
  controller.impulse = 3.0 * unit.force;
  controller.impulse_width = 0.1 * unit.time;
  controller.impulse_pause = 0.4 * unit.time;
  controller.impulse_band = 0.02 * unit.length;
  controller.impulse_speed = 1e-3 * unit.length / unit.time;
  parts.controller = controller;
  return parts;
}

/// The places at which the body stands after each of some intervals, in the unit of length.
std::vector<double> places(const Units& unit, double from, int count) {
  const Loop loop = build_loop(pushed(unit));
  LoopField field(loop);
  const LoopState begin = displaced(loop, from * unit.length);
  field.modes() = begin.modes;
  March march(field, StepperKind::automatic, loop_weights(loop, 1e-9));
  CHECK(march.kind() == StepperKind::exact);
  march.begin(begin.x, 0.0);
  std::vector<double> found;
  for (int k = 1; k <= count; ++k) {
    const double until = (0.5 * k - 1e-3) * unit.time;
    while (march.t() < until) REQUIRE(march.step(until) == Status::converged);
    found.push_back(field.y(march.x()) / unit.length);
  }
  return found;
}

}  // namespace

TEST_CASE("impulses: each moves the body by the hop in closed form, until it stands within the band") {
  // m = 2: (P - Fc)/m for a tenth of a second, then back to rest at Fc/m: P (P - Fc) width^2/(2 m Fc).
  const double hop = 3.0 * 2.0 * 0.01 / 4.0;
  for (const Units& unit : {Units{}, Units{1e-3, 1.0, 1.0}, Units{1.0, 1e-2, 50.0}})
    for (const double side : {1.0, -1.0}) {
      const auto found = places(unit, side * 0.1, 10);
      for (int k = 1; k <= 10; ++k) {
        CAPTURE(unit.length, unit.time, side, k);
        // 0.1 - 6 hops = 0.01 is within the band of 0.02.
        CHECK(side * found[static_cast<std::size_t>(k - 1)] == Approx(0.1 - std::min(k, 6) * hop).epsilon(1e-9));
      }
    }
}

TEST_CASE("impulses: none within the band, none while the body moves, and a change of sign turns them") {
  const Loop loop = build_loop(pushed({}));
  const Element& element = loop.elements.front();
  REQUIRE(element.kind() == "impulses");
  LoopField field(loop);
  State x = displaced(loop, 0.019).x;
  field.start(x, 0.0);
  CHECK(field.modes().front() == Mode{0});
  Impulses<double> impulses;
  impulses.force = 3.0;
  impulses.width = 0.1;
  impulses.pause = 0.4;
  impulses.band = 0.02;
  impulses.speed = 1e-3;
  double z[] = {0.0};
  CHECK(impulses.next({0.1, 5e-4, 0.0}, Mode{0}, z, 2) == Mode{2});  // beyond the band
  CHECK(z[0] == 0.1);
  CHECK(impulses.output({0.1, 0.0, 0.0}, Mode{2}, z) == 3.0);
  CHECK(impulses.next({0.1, 0.2, 0.0}, Mode{2}, z, 0) == Mode{3});  // the impulse ends
  CHECK(z[0] == Approx(0.4));
  CHECK(impulses.output({0.1, 0.0, 0.0}, Mode{3}, z) == 0.0);
  CHECK(impulses.next({0.1, 0.2, 0.0}, Mode{3}, z, 0) == Mode{1});     // the body still moves
  CHECK(impulses.next({-0.1, 1e-3, 0.0}, Mode{1}, z, 0) == Mode{-2});  // it stops on the other side
  CHECK(impulses.next({-0.1, 0.0, 0.0}, Mode{3}, z, 0) == Mode{-2});   // or has stopped during the pause
  CHECK(impulses.next({-0.01, 0.0, 0.0}, Mode{3}, z, 0) == Mode{0});   // or stands within the band
  CHECK(impulses.next({-0.01, 1e-3, 0.0}, Mode{0}, z, 0) == Mode{1});
  CHECK(impulses.next({-0.01, -1e-3, 0.0}, Mode{0}, z, 1) == Mode{-1});
}

TEST_CASE("stop reset: only an integral that pushes away from the set-point is reset, for a gain of either sign") {
  for (const double gain : {2.0, -2.0})
    for (const double share : {0.5, 1.0, 2.0}) {
      StopResetIntegrator<double> integral;
      integral.gain = gain;
      integral.share = share;
      integral.speed = 1e-3;
      const double towards = gain > 0.0 ? 0.7 : -0.7;  // for x > 0
      for (const double side : {1.0, -1.0}) {
        double away[] = {-side * towards}, right[] = {side * towards};
        CHECK(integral.next({side * 0.1, 1e-3, 0.0}, Mode{1}, away, 0) == Mode{0});
        CHECK(away[0] == Approx(-(1.0 - share) * side * towards).margin(1e-15));
        CHECK(integral.next({side * 0.1, 1e-3, 0.0}, Mode{1}, right, 0) == Mode{0});
        CHECK(right[0] == side * towards);
        CHECK(integral.next({side * 0.1, 1e-3, 0.0}, Mode{0}, away, 0) == Mode{1});
        CHECK(integral.next({side * 0.1, -1e-3, 0.0}, Mode{0}, away, 1) == Mode{-1});
      }
    }
}

TEST_CASE("stop reset: sizes of its state do not depend on the units, and the march is exact") {
  const auto size = [](double length, double time) {
    LoopParts parts = test::servo_parts(test::coulomb(1.5, 1.0));
    parts.plant = Mass{time * time / length, 0.0, 0.0};
    Pid controller = test::pid(3.0 / length, 4.0 / (length * time), 6.0 * time / length);
    controller.integral_reset = 1.0;
    controller.reset_speed = 1e-3 * length / time;
    parts.controller = controller;
    const Loop loop = build_loop(parts);
    CHECK(loop.elements.front().kind() == "stop-reset-integrator");
    LoopField field(loop);
    CHECK(March(field, StepperKind::automatic, loop_weights(loop, 1e-9)).kind() == StepperKind::exact);
    return typical_sizes(loop).at(2);  // of the integral, N
  };
  const double force = size(1.0, 1.0);
  CHECK(force > 0.1);
  CHECK(force < 10.0);
  CHECK(size(1e-6, 1e-3) == Approx(force).epsilon(1e-9));
}

TEST_CASE("stop reset: a servo that overshoots and stops has its integral turned round there, and not before") {
  LoopParts parts = test::servo_parts(test::coulomb(1.5, 1.0));
  Pid controller = test::pid(3.0, 4.0, 6.0);
  controller.integral_reset = 2.0;
  controller.reset_speed = 1e-4;
  parts.controller = controller;
  const Loop loop = build_loop(parts);
  LoopField field(loop);
  const LoopState begin = displaced(loop, 1.0);
  field.modes() = begin.modes;
  March march(field, StepperKind::automatic, loop_weights(loop, 1e-9));
  march.begin(begin.x, 0.0);
  const auto integral = field.first_state(0);
  int turned = 0;
  while (march.t() < 60.0) {
    const double before = march.x()[integral];
    REQUIRE(march.step(60.0) == Status::converged);
    if (march.last().switched != 0 || march.x()[integral] == before) continue;
    const double e = -field.y(march.x()), now = march.x()[integral];
    if (std::abs(now + march.last().x1[integral]) > 1e-9) continue;  // no reset
    ++turned;
    CHECK(now * e > 0.0);
  }
  CHECK(turned >= 1);
}
