#include "limcycle/analysis/motion/march.hpp"

#include <catch2/catch.hpp>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// Oscillator m = 1 kg, k = 4 N/m with Coulomb friction, no controller (claim B5).
Loop oscillator(double Fs, double Fc) {
  LoopParts parts;
  parts.plant = Mass{1.0, 0.0, 4.0};
  parts.friction = coulomb(Fs, Fc);
  return build_loop(parts);
}

}  // namespace

TEST_CASE("free oscillator with Coulomb friction: loses 2 Fc/k a half cycle, keeps its frequency, then stays at rest") {
  const Loop loop = oscillator(0.5, 0.5);
  for (const auto kind :
       {StepperKind::rodas5p, StepperKind::dopri5, StepperKind::fehlberg78, StepperKind::cash_karp54}) {
    LoopField field(loop);
    March march(field, kind, loop_weights(loop, 1e-11));
    State x{1.0, 0.0};
    field.start(x, 0.0);
    march.begin(x, 0.0);
    std::vector<double> times, stops;
    while (march.t() < 20.0) {
      REQUIRE(march.step(20.0) == Status::converged);
      if (march.last().switched) {
        times.push_back(march.t());
        stops.push_back(march.x()[0]);
      }
    }
    const double half = std::acos(-1.0) / 2.0;  // of the period 2 pi / sqrt(k/m)
    REQUIRE(times.size() == 4);                 // 1 -> -0.75 -> 0.5 -> -0.25 -> 0
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(times[i] == Approx(half * double(i + 1)).epsilon(1e-9));
      CHECK(stops[i] == Approx((i % 2 ? 1.0 : -1.0) * (1.0 - 0.25 * double(i + 1))).margin(1e-9));
    }
    CHECK(field.modes()[0] == Mode{0});
    CHECK(std::abs(march.x()[1]) < 1e-15);  // no creep
    CHECK(march.x()[0] == stops.back());
  }
}

TEST_CASE("a stuck body stays exactly where it is for a million seconds") {
  const Loop loop = oscillator(1.5, 1.0);
  LoopField field(loop);
  March march(field, StepperKind::automatic, loop_weights(loop, 1e-6));
  State x{0.3, 0.0};  // spring force 1.2 N < Fs
  field.start(x, 0.0);
  march.begin(x, 0.0);
  while (march.t() < 1e6) REQUIRE(march.step(1e6) == Status::converged);
  CHECK(march.x()[0] == Approx(0.3).epsilon(1e-15));
  CHECK(march.x()[1] == 0.0);
  CHECK(march.events() == 0);
}

TEST_CASE("a body on a curve of infinite slope breaks away after a long wait, and was exactly still until then") {
  // In N, m, s. Within the rounding of t = 2000 s its velocity exceeds the tolerance.
  auto law = stribeck(0.890051, 0.424566, 0.0259347);
  law.delta = 0.5;
  law.sigma2 = 0.0140579;
  LoopParts parts = servo_parts(law);
  parts.plant = Mass{0.000469045, 0.0, 0.0};
  parts.controller = pid(28.8061, 479.098, 0.2426);
  const Loop loop = build_loop(parts);
  for (const double rtol : {1e-6, 1e-7, 1e-9, 3e-12}) {
    LoopField field(loop);
    March march(field, StepperKind::automatic, loop_weights(loop, rtol));
    LoopState start = displaced(loop, 8.917e-7);
    field.modes() = start.modes;
    march.begin(start.x, 0.0);
    int slips = 0;
    while (slips < 6) {
      REQUIRE(march.step(1e5) == Status::converged);
      REQUIRE(march.t() < 1e5);
      if (field.holds(0)) CHECK(march.x()[1] == 0.0);
      if (march.last().switched && !field.holds(0)) ++slips;
    }
    CHECK(march.t() > 2000.0);
  }
}

TEST_CASE("events are located to the accuracy of the stepper: order of the switching time") {
  // Relay with hysteresis followed by 1/s: switches at the known times (claim B1), for any step.
  const Loop loop = forward(relay(1.0, 0.1), {1.0}, {1.0, 0.0});
  LoopField field(loop);
  March march(field, StepperKind::dopri5, loop_weights(loop, 1e-3));
  State x{0.0};
  field.start(x, 0.0);
  march.begin(x, 0.0);
  std::vector<double> times;
  while (times.size() < 6) {
    REQUIRE(march.step(100.0) == Status::converged);
    if (march.last().switched) times.push_back(march.t());
  }
  for (std::size_t i = 1; i < times.size(); ++i) CHECK(times[i] - times[i - 1] == Approx(0.2).epsilon(1e-12));
}

TEST_CASE("crossings of a section stop the march on it, and a start on it does not count") {
  LoopParts parts;
  parts.plant = Mass{1.0, 0.0, 1.0};
  parts.friction = lugre(1e-9, 1e-9, 0.0);  // practically none
  auto law = lugre(1e-9, 1e-9, 0.0);
  law.sigma0 = 1.0;
  law.sigma1 = 0.0;
  parts.friction = law;
  const Loop loop = build_loop(parts);
  LoopField field(loop);
  March march(field, StepperKind::rodas5p, loop_weights(loop, 1e-10));
  march.begin({0.5, std::sqrt(0.75), 0.0}, 0.0, Section{Eigen::RowVector2d(1.0, 0.0), 0.5, 1});
  do REQUIRE(march.step(100.0) == Status::converged);
  while (!march.last().on_section);
  CHECK(march.t() == Approx(2.0 * std::acos(-1.0)).epsilon(1e-7));
  CHECK(march.x()[0] == Approx(0.5).epsilon(1e-12));
}

TEST_CASE("Zeno switching ends with a status, not a hang") {
  // Double integrator with relay on a combination that chatters: x'' = -sgn(x' + x) slides along x' = -x only if held;
  // behind a fast filter the relay cannot hold, so switches accumulate.
  const Loop loop = forward(relay(1.0), {1.0, 1.0}, {1e-9, 1.0, 0.0, 0.0});
  LoopField field(loop);
  March march(field, StepperKind::rodas5p, loop_weights(loop, 1e-6));
  State x{0.0, 0.0, 1e-3};
  field.start(x, 0.0);
  march.begin(x, 0.0);
  Status status = Status::converged;
  while (status == Status::converged && march.t() < 50.0 && march.steps() < 300000) status = march.step(50.0);
  CHECK((status == Status::chattering || march.t() >= 50.0));
}

TEST_CASE("a state that is not finite is reported") {
  const Loop loop = oscillator(1.5, 1.0);
  LoopField field(loop);
  March march(field, StepperKind::dopri5, loop_weights(loop, 1e-6));
  march.begin({std::nan(""), 0.0}, 0.0);
  CHECK(march.step(1.0) == Status::not_finite);
}

TEST_CASE("tolerances: velocity at a friction law is bounded by vs, bristle by Fs/sigma0") {
  const auto weights = loop_weights(servo(lugre()), 1e-6);
  CHECK(weights.atol[1] <= 1e-6 * 1e-3);
  CHECK(weights.atol[3] == Approx(1e-6 * 1.5e-5));
  CHECK_THROWS_AS(loop_weights(servo(lugre()), 0.0), std::invalid_argument);
}

TEST_CASE("steppers are chosen by stiffness and tolerance") {
  CHECK(choose_stepper(servo(lugre()), 1e-6) == StepperKind::rodas5p);
  CHECK(choose_stepper(servo(coulomb(1.5, 1.0)), 1e-6) == StepperKind::exact);
  CHECK(choose_stepper(servo(coulomb(1.5, 1.0)), 1e-6, true) == StepperKind::dopri5);
  CHECK(choose_stepper(servo(stribeck(1.5, 1.0, 1e-3)), 1e-6) == StepperKind::dopri5);
  CHECK(choose_stepper(servo(stribeck(1.5, 1.0, 1e-3)), 1e-11) == StepperKind::fehlberg78);
  CHECK(choose_stepper(forward(relay(1.0), {1.0}, {1e-6, 1.0, 1.0}), 1e-6, true) == StepperKind::rodas5p);
  CHECK(stepper_kind("dopri5") == StepperKind::dopri5);
  CHECK_THROWS_AS(stepper_kind("euler"), std::invalid_argument);
}
