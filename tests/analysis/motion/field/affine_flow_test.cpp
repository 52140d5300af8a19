#include "limcycle/analysis/motion/field/affine_flow.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/models/element/with_memory/backlash.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// y at time t of a plant behind a relay that is on from the start, from rest.
double step_response(const std::vector<double>& numerator, const std::vector<double>& denominator, double t) {
  const Loop loop = forward(relay(1.0, 1e3), numerator, denominator);  // it never switches
  LoopField field(loop);
  field.modes() = {Mode{1}};
  AffineFlow flow(field);
  const State rest(field.size(), 0.0);
  State x;
  AffineFlow::apply(flow.over(t), rest, x);
  return field.y(x);
}

/// State of the march by this stepper at `until`, and the times of its switches.
struct Run {
  State x;
  std::vector<double> switches;
  long steps = 0;
};

Run marched(const Loop& loop, const State& from, StepperKind kind, double until, double rtol = 1e-12) {
  LoopField field(loop);
  State x = from;
  field.start(x, 0.0);
  March march(field, kind, loop_weights(loop, rtol));
  march.begin(x, 0.0);
  Run run;
  while (march.t() < until) {
    REQUIRE(march.step(until) == Status::converged);
    if (march.last().switched) run.switches.push_back(march.t());
  }
  run.x = march.x();
  run.steps = march.steps();
  return run;
}

void check_same(const Run& exact, const Run& other, double accuracy) {
  REQUIRE(exact.switches.size() == other.switches.size());
  for (std::size_t i = 0; i < exact.switches.size(); ++i)
    CHECK(other.switches[i] == Approx(exact.switches[i]).epsilon(accuracy));
  for (std::size_t i = 0; i < exact.x.size(); ++i) CHECK(std::abs(other.x[i] - exact.x[i]) < accuracy);
}

}  // namespace

TEST_CASE("affine flow: step responses in closed form") {
  for (const double t : {1e-6, 0.01, 0.7, 5.0, 40.0}) {
    // Repeated pole: 1/(s + 1)^3. A tiny value is a difference of terms of size 1, in the closed form too.
    CHECK(
        std::abs(step_response({1.0}, {1.0, 3.0, 3.0, 1.0}, t) -
                 (t < 0.1 ? std::pow(t, 3) / 6.0 - std::pow(t, 4) / 8.0 + std::pow(t, 5) / 20.0 - std::pow(t, 6) / 72.0
                          : 1.0 - std::exp(-t) * (1.0 + t + 0.5 * t * t))) < 2e-14);
    // Integrators: 1/s, 1/s^2, 1/(s^2 (s + 1)).
    CHECK(step_response({1.0}, {1.0, 0.0}, t) == Approx(t).epsilon(1e-14));
    CHECK(step_response({1.0}, {1.0, 0.0, 0.0}, t) == Approx(0.5 * t * t).epsilon(1e-14));
    CHECK(std::abs(step_response({1.0}, {1.0, 1.0, 0.0, 0.0}, t) - (0.5 * t * t - t - std::expm1(-t))) <
          1e-14 * (1.0 + t * t));
    // Undamped: 1/(s^2 + 4).
    CHECK(std::abs(step_response({1.0}, {1.0, 0.0, 4.0}, t) - 0.5 * std::pow(std::sin(t), 2)) < 2e-14 * (1.0 + t));
    // A lag of 1e-6 s next to one of 1 s: the slow part is as accurate as without it.
    const double a = 1e-6;
    CHECK(std::abs(step_response({1.0}, {a, 1.0 + a, 1.0}, t) -
                   (1.0 - (std::exp(-t) - a * std::exp(-t / a)) / (1.0 - a))) < 1e-14);
  }
}

TEST_CASE("affine flow: kept powers are the flow over powers of two, in whatever mode the field is") {
  const Loop loop = servo(coulomb(1.5, 1.0, 0.4));
  LoopField field(loop);
  AffineFlow flow(field);
  for (int round = 0; round < 2; ++round)
    for (const std::int64_t mode : {1, 0, -1}) {
      field.modes() = {Mode{mode}};
      for (int k = -12; k <= 3; ++k)
        CHECK((flow.over_power(k) - flow.over(std::ldexp(1.0, k))).cwiseAbs().maxCoeff() == 0.0);
      // Twice 2^k is 2^(k+1).
      const Eigen::MatrixXd twice = flow.over_power(-3) * flow.over_power(-3);
      CHECK((twice - flow.over_power(-2)).cwiseAbs().maxCoeff() < 1e-14);
    }
  // Stuck: neither v nor y moves, I falls at the rate given by y.
  field.modes() = {Mode{0}};
  State x;
  AffineFlow::apply(flow.over(3.0), {0.1, 0.0, 0.2}, x);
  CHECK(x[0] == Approx(0.1).epsilon(1e-15));
  CHECK(std::abs(x[1]) < 1e-16);
  CHECK(x[2] == Approx(0.2 - 0.3).epsilon(1e-14));
}

TEST_CASE("affine flow: applies to piecewise affine elements only") {
  CHECK(AffineFlow::applies(servo(coulomb(1.5, 1.0))));
  CHECK(AffineFlow::applies(forward(relay(1.0), {1.0}, {1.0, 1.0})));
  CHECK(AffineFlow::applies(forward(Backlash<double>{1.0, 0.1}, {1.0}, {1.0, 1.0, 0.0})));
  CHECK_FALSE(AffineFlow::applies(servo(lugre())));
  CHECK_FALSE(AffineFlow::applies(servo(stribeck(1.5, 1.0, 1e-3))));
  auto parts = servo_parts(lugre());
  auto controller = pid(3.0, 4.0, 6.0);
  controller.saturation = 2.0;
  parts.controller = controller;
  CHECK_FALSE(AffineFlow::applies(build_loop(parts)));
}

TEST_CASE("the exact march agrees with tightly integrated ones through stick and slip and switches") {
  const Loop stick_slip = servo(coulomb(1.5, 1.0, 0.4));
  const Run exact = marched(stick_slip, {0.3, 0.0, 0.0}, StepperKind::exact, 60.0);
  CHECK(exact.switches.size() >= 8);
  check_same(exact, marched(stick_slip, {0.3, 0.0, 0.0}, StepperKind::fehlberg78, 60.0), 1e-9);
  check_same(exact, marched(stick_slip, {0.3, 0.0, 0.0}, StepperKind::rodas5p, 60.0), 1e-8);

  // A saturated command behind an actuator with a lag of 1e-6 s: stiff.
  auto parts = servo_parts(coulomb(1.5, 1.0, 0.4));
  auto controller = pid(3.0, 4.0, 6.0);
  controller.saturation = 1.8;
  controller.lag = 1e-6;
  parts.controller = controller;
  const Loop stiff = build_loop(parts);
  const State from{1.0, 0.0, 0.0, 0.0};
  const Run stiffly = marched(stiff, from, StepperKind::exact, 10.0);
  CHECK(stiffly.switches.size() >= 3);
  check_same(stiffly, marched(stiff, from, StepperKind::rodas5p, 10.0, 1e-11), 1e-7);

  const Loop third = forward(relay(1.0, 0.0, 0.05), {1.0}, {1.0, 3.0, 3.0, 1.0});
  const Run relay_run = marched(third, {1.0, 0.0, 0.5}, StepperKind::exact, 30.0);
  CHECK(relay_run.switches.size() >= 10);
  check_same(relay_run, marched(third, {1.0, 0.0, 0.5}, StepperKind::fehlberg78, 30.0), 1e-9);
}

TEST_CASE("the exact march finds switching times to rounding") {
  // Relay before 1/(s + 1): from 0 to the first switch ln(1/(1 - eps)), then ln((1 + eps)/(1 - eps)) each.
  const double eps = 0.2;
  const Run lag = marched(forward(relay(1.0, eps), {1.0}, {1.0, 1.0}), {0.0}, StepperKind::exact, 6.0);
  REQUIRE(lag.switches.size() >= 10);
  for (std::size_t i = 0; i < lag.switches.size(); ++i)
    CHECK(lag.switches[i] ==
          Approx(-std::log(1.0 - eps) + static_cast<double>(i) * std::log((1.0 + eps) / (1.0 - eps))).epsilon(1e-13));
  // Oscillator with Coulomb friction: turns every pi/w, each time 2 Fc/k shorter, and stops.
  LoopParts parts;
  parts.plant = Mass{1.0, 0.0, 4.0};
  parts.friction = coulomb(0.5, 0.5);
  const Run free = marched(build_loop(parts), {1.05, 0.0}, StepperKind::exact, 20.0);
  REQUIRE(free.switches.size() == 4);
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(free.switches[i] == Approx(0.5 * std::acos(-1.0) * static_cast<double>(i + 1)).epsilon(1e-13));
  CHECK(free.x[0] == Approx(0.05).epsilon(1e-12));
  CHECK(free.x[1] == 0.0);
}
