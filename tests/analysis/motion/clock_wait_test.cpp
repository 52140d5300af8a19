// The wait of a stuck body for its sampled controller, leapt over: against closed forms of the sample at which the
// command breaks it away, and against the wait sample by sample.
#include "limcycle/analysis/motion/clock_wait.hpp"

#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/sampling.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/models/delay.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

constexpr double sticking = 1.5, held_at = 1e-5;

LoopParts waiting_servo(const Pid& controller) {
  LoopParts parts = servo_parts(coulomb(sticking, 1.0));
  parts.controller = controller;
  return parts;
}

Pid sampled_pid(double time, double delay) {
  Pid controller = pid(3.0, 4.0, 6.0);
  controller.sample_time = time;
  controller.computation_delay = delay;
  return controller;
}

struct Waited {
  double time = 0.0;  ///< at which the body broke away; infinite if it never did
  long steps = 0;
};

Waited wait_of(const LoopParts& parts, double longest) {
  const Loop loop = in_time_domain(build_loop(parts), 1).loop;
  const LoopState start = sampled_state(loop, Eigen::Vector3d(held_at, 0.0, 0.0));
  LoopField field(loop);
  field.modes() = start.modes;
  March march(field, StepperKind::exact, loop_weights(loop, 1e-10));
  march.begin(start.x, 0.0);
  while (march.t() < longest) {
    REQUIRE(march.step(longest) == Status::converged);
    if (march.last().switched == loop.elements.size() - 1) return {march.t(), march.steps()};
  }
  CHECK(field.y(march.x()) == held_at);
  return {infinite, march.steps()};
}

}  // namespace

TEST_CASE("waiting for a sampled controller: it breaks the body away at the sample of the closed form") {
  const double delay = GENERATE(0.0, 0.003), quantum = GENERATE(0.0, 0.0137), unit = GENERATE(1.0, 1e-3);
  const double time = 0.01 * unit;
  CAPTURE(delay, quantum, unit);
  Pid controller = sampled_pid(time, delay * unit);
  controller.output_step = quantum;
  const Waited found = wait_of(waiting_servo(controller), 1e9);
  // The command of reading k = 0, 1, ... is (kp + ki T (k + 1)) held_at; of its quanta, the first beyond it.
  const double enough = quantum > 0.0 ? quantum * (std::floor(sticking / quantum) + 0.5) : sticking;
  const double readings = std::ceil((enough / held_at - 3.0) / (4.0 * time)) - 1.0;
  CHECK(found.time == Approx(readings * time + delay * unit).margin(1.5 * time));
  CHECK(found.steps < (quantum > 0.0 ? 100'000 : 3000));
}

TEST_CASE("waiting for a sampled controller: at its limit, or without an integral, the body stays for ever") {
  Pid limited = sampled_pid(0.01, 0.003), without = limited;
  limited.saturation = 1.4;
  without.ki = 0.0;
  for (const Pid& controller : {limited, without}) {
    const Waited found = wait_of(waiting_servo(controller), 1e9);
    CHECK(found.time == infinite);
  }
  limited.saturation = 1.6;
  CHECK(wait_of(waiting_servo(limited), 1e9).time == Approx((sticking / held_at - 3.0) / 4.0).margin(0.03));
}

TEST_CASE("waiting for a sampled controller: leaps end in the state of the wait sample by sample, at two rates") {
  Cascade law;
  law.position_kp = 1.5;
  law.velocity_kp = 6.0;
  law.velocity_ki = 8.0;
  law.sample_time = 0.01;
  law.position_every = 4.0;
  law.velocity_window = 3.0;
  law.computation_delay = 0.004;
  LoopParts parts = waiting_servo(pid(0.0, 0.0, 0.0));
  parts.controller = law;
  const Loop loop = in_time_domain(build_loop(parts), 1).loop;
  const LoopState start = sampled_state(loop, Eigen::Vector3d(held_at, 0.0, 0.0));
  const double until = 300.0 + 0.37 * law.sample_time;
  const auto state_after = [&](double stride) {
    LoopField field(loop);
    field.modes() = start.modes;
    March march(field, StepperKind::exact, loop_weights(loop, 1e-10));
    march.begin(start.x, 0.0);
    for (double t = stride; march.t() < until; t = std::min(t + stride, until))
      while (march.t() < t) REQUIRE(march.step(t) == Status::converged);
    return std::pair(march.x(), march.steps());
  };
  const auto [leapt, few] = state_after(until);
  const auto [stepped, many] = state_after(4.0 * law.sample_time);
  CHECK(few < many / 20);
  REQUIRE(leapt.size() == stepped.size());
  for (std::size_t i = 0; i < leapt.size(); ++i) {
    CAPTURE(i);
    CHECK(leapt[i] == Approx(stepped[i]).epsilon(1e-8).margin(1e-9));
  }
}
