#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/models/element/of_controllers/reset_integrator.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using std::numbers::pi;

namespace {

ResetIntegrator<double> resetting(double gain, double share, double interval) {
  ResetIntegrator<double> element;
  element.gain = gain;
  element.share = share;
  element.interval = interval;
  return element;
}

/// An integrator behind a reset one, y' = z, z' = -gain y, from y = 1: |y| half-way between two zeros, for the first
/// of them. Between zeros it is a sinusoid of frequency sqrt(gain), and at a reset z shrinks.
std::vector<double> swings(double gain, double share, double interval, int count) {
  const Loop loop = test::forward(resetting(gain, share, interval), {1.0}, {1.0, 0.0});
  LoopField field(loop);
  LoopState from = without_history(loop, Eigen::VectorXd::Constant(1, 1.0 / loop.C_y(0)));
  field.modes() = from.modes;
  March march(field, StepperKind::automatic, loop_weights(loop, 1e-9));
  CHECK(march.kind() == StepperKind::exact);
  march.begin(from.x, 0.0);
  std::vector<double> found;
  for (int k = 1; k <= count; ++k) {
    const double at = k * pi / std::sqrt(gain);
    while (march.t() < at) REQUIRE(march.step(at) == Status::converged);
    found.push_back(std::abs(field.y(march.x())));
  }
  return found;
}

}  // namespace

TEST_CASE("reset integrator: each reset leaves a share of the swing, in two units of time") {
  for (const double gain : {1.0, 4e6})
    for (const double share : {0.0, 0.25, 1.0}) {
      const auto found = swings(gain, share, 0.0, 4);
      CAPTURE(gain, share);
      for (std::size_t k = 0; k < found.size(); ++k)
        CHECK(found[k] == Approx(std::pow(1.0 - share, k + 1)).margin(1e-12));
    }
}

TEST_CASE("reset integrator: within the interval a crossing passes without a reset") {
  for (const double gain : {1.0, 1e-4}) {
    const double half_turn = pi / std::sqrt(gain);
    // Half-way to the next but one zero: every other one resets; beyond that, every third.
    const auto second = swings(gain, 0.5, 1.5 * half_turn, 6), third = swings(gain, 0.5, 2.5 * half_turn, 6);
    for (std::size_t k = 0; k < 6; ++k) {
      CHECK(second[k] == Approx(std::pow(0.5, 1 + k / 2)).epsilon(1e-10));
      CHECK(third[k] == Approx(std::pow(0.5, 1 + k / 3)).epsilon(1e-10));
    }
  }
}

TEST_CASE("reset integrator: sizes of its states do not depend on the units") {
  const auto size = [](double length, double time) {
    LoopParts parts = test::servo_parts(test::coulomb(1.5, 1.0));
    parts.plant = Mass{time * time / length, 0.0, 0.0};
    Pid controller = test::pid(3.0 / length, 4.0 / (length * time), 6.0 * time / length);
    controller.integral_reset = 1.0;
    controller.reset_interval = 0.1 * time;
    parts.controller = controller;
    const Loop loop = build_loop(parts);
    CHECK(loop.elements.front().kind() == "reset-integrator");
    const State sizes = typical_sizes(loop);
    return std::pair(sizes.at(2), sizes.at(3));  // of the integral, N, and of its clock, s
  };
  const auto [force, clock] = size(1.0, 1.0);
  CHECK(force > 0.1);
  CHECK(force < 10.0);
  const auto [same, scaled] = size(1e-6, 1e-3);
  CHECK(same == Approx(force).epsilon(1e-9));
  CHECK(scaled == Approx(1e-3 * clock).epsilon(1e-12));
}

// The rates of a body that creeps are differences of forces that all but cancel: their rounding is no fault of the
// step.
TEST_CASE("reset integrator: the derivative of a body that creeps takes steps about as long as the motion itself") {
  for (const double share : {1.02, 1.3}) {
    auto parts = test::servo_parts(test::lugre());
    auto controller = test::pid(3.0, 4.0, 6.0);
    controller.integral_reset = share;
    parts.controller = controller;
    const Loop loop = build_loop(parts);
    LoopField field(loop);
    const auto steps_of = [&](State& x, double duration, double rtol, bool derivative) {
      March march(field, StepperKind::rodas5p, loop_weights(loop, rtol));
      march.track(derivative);
      march.begin(x, 0.0);
      while (march.t() < duration && march.steps() < 10'000) REQUIRE(march.step(duration) == Status::converged);
      CHECK(march.t() == duration);
      x = march.x();
      return march.steps();
    };
    State x(field.size(), 0.0);
    x[0] = 1.0;
    field.start(x, 0.0);
    steps_of(x, 1e6, 1e-9, false);
    const std::vector<Mode> modes = field.modes();
    for (const double rtol : {1e-6, 1e-8}) {
      CAPTURE(share, rtol);
      State plain = x, followed = x;
      field.modes() = modes;
      const long alone = steps_of(plain, 3e5, rtol, false);
      field.modes() = modes;
      CHECK(steps_of(followed, 3e5, rtol, true) < 200 + 5 * alone);
    }
  }
}
