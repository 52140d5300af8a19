#include "limcycle/models/element/sampled.hpp"

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

/// A mass of 1 kg with dry friction under a PID on a computer, in closed form: between two changes of the command it
/// rests or has a constant acceleration.
struct HeldServo {
  double Fs, Fc, kp, ki, kd, time, delay, quantum;
  double y, v, integral, last, command;

  void move(double left) {
    while (left > 0.0) {
      if (v == 0.0) {
        if (std::abs(command) <= Fs) return;
        v = 0.0;
      }
      const double direction = v != 0.0 ? std::copysign(1.0, v) : std::copysign(1.0, command);
      const double a = command - Fc * direction;
      const double stop = v * a < 0.0 ? -v / a : infinite, h = std::min(left, stop);
      y += h * (v + 0.5 * h * a);
      v = h == stop ? 0.0 : v + h * a;
      left -= h;
    }
  }
  void period() {
    const double e = -(quantum > 0.0 ? quantum * std::round(y / quantum) : y);
    integral += time * e;
    const double next = kp * e + ki * integral + kd * (e - last) / time;
    last = e;
    move(delay);
    command = next;
    move(time - delay);
  }
};

LoopParts sampled_servo(double time, double delay, double quantum) {
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  Pid& controller = std::get<Pid>(parts.controller);
  controller.sample_time = time;
  controller.computation_delay = delay;
  controller.encoder_quantum = quantum;
  return parts;
}

}  // namespace

TEST_CASE("sampled PID with dry friction: position and velocity are those of the closed form, sample for sample") {
  const double delay = GENERATE(0.0, 0.003), quantum = GENERATE(0.0, 0.0137);
  const double time = 0.01;
  INFO("delay " << delay << ", quantum " << quantum);
  const Loop loop = in_time_domain(build_loop(sampled_servo(time, delay, quantum)), 1).loop;
  const double y0 = 0.7123;
  HeldServo servo{1.5, 1.0, 3.0, 4.0, 6.0, time, delay, quantum, y0, 0.0, 0.0, 0.0, 0.0};
  const double read = quantum > 0.0 ? quantum * std::round(y0 / quantum) : y0;
  servo.last = -read;
  if (delay > 0.0) servo.command = 0.0;

  const LoopState start = sampled_state(loop, Eigen::Vector3d(y0, 0.0, 0.0));
  for (const StepperKind kind : {StepperKind::exact, StepperKind::rodas5p}) {
    HeldServo reference = servo;
    LoopField field(loop);
    field.modes() = start.modes;
    March march(field, kind, loop_weights(loop, 1e-10));
    march.begin(start.x, 0.0);
    const double tolerance = kind == StepperKind::exact ? 1e-9 : 1e-6;
    for (int k = 1; k <= 3000; ++k) {
      reference.period();
      const double t = (k - 1e-6) * time;
      while (march.t() < t) REQUIRE(march.step(t) == Status::converged);
      REQUIRE(field.y(march.x()) == Approx(reference.y).margin(tolerance + 2e-6 * time * std::abs(reference.v)));
    }
    CHECK(march.events() > 3000);
  }
}

TEST_CASE("sampled element: differences of a PID, rounding of both ends, and a clock") {
  Sampled<double> element;
  element.sample_time = 0.1;
  element.input_quantum = 0.25;
  element.output_quantum = 0.5;
  element.D = 2.0;
  double z[2];
  const Mode mode = element.start({0.3, 0.0, 0.0}, z);
  CHECK(z[0] == 0.1);
  CHECK(z[1] == 0.5);  // 0.3 is read as 0.25
  CHECK(element.due(mode, z) == 0.1);
  element.next({0.4, 0.0, 0.0}, mode, z, 0);
  CHECK(z[1] == 1.0);  // 0.4 as 0.5
  CHECK(element.order() == 0);
  element.computation_delay = 0.2;
  REQUIRE(element.validate().has_value());
  CHECK(element.validate()->key == "computation_delay");
}
