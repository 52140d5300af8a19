#include "limcycle/models/element/of_controllers/sampled.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "limcycle/analysis/motion/field/affine_flow.hpp"
#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/sampling.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/models/delay.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// A mass of 1 kg with dry friction under a held command, in closed form: it rests or has a constant acceleration.
struct HeldMass {
  double Fs, Fc;
  double y, v, command;

  void move(double left) {
    while (left > 0.0) {
      if (v == 0.0 && std::abs(command) <= Fs) return;
      const double direction = v != 0.0 ? std::copysign(1.0, v) : std::copysign(1.0, command);
      const double a = command - Fc * direction;
      const double stop = v * a < 0.0 ? -v / a : infinite, h = std::min(left, stop);
      y += h * (v + 0.5 * h * a);
      v = h == stop ? 0.0 : v + h * a;
      left -= h;
    }
  }
};

double rounded_to(double quantum, double y) { return quantum > 0.0 ? quantum * std::round(y / quantum) : y; }

/// That mass under a PID on a computer, its derivative over some samples.
struct HeldServo : HeldMass {
  double kp, ki, kd, time, delay, quantum;
  double integral;
  std::vector<double> past;  ///< readings of e, the last one first

  void period() {
    const double e = -rounded_to(quantum, y);
    integral += time * e;
    const double next = kp * e + ki * integral + kd * (e - past.back()) / (static_cast<double>(past.size()) * time);
    past.insert(past.begin(), e);
    past.pop_back();
    move(delay);
    command = next;
    move(time - delay);
  }
};

/// That mass under a cascade on a computer.
struct HeldCascade : HeldMass {
  Cascade law;
  int tick = 0;
  double position_integral = 0.0, velocity_integral = 0.0, wanted = 0.0;
  std::vector<double> past;  ///< readings of y, the last one first; none: v is measured

  void period() {
    const double read = rounded_to(law.input_step, y), every = law.position_every;
    if (tick++ % static_cast<int>(every) == 0) {
      position_integral -= every * law.sample_time * read;
      wanted = -law.position_kp * read + law.position_ki * position_integral;
    }
    double speed = v;
    if (!past.empty()) {
      speed = (read - past.back()) / (static_cast<double>(past.size()) * law.sample_time);
      past.insert(past.begin(), read);
      past.pop_back();
    }
    velocity_integral += law.sample_time * (wanted - speed);
    const double asked = law.velocity_kp * (wanted - speed) + law.velocity_ki * velocity_integral;
    const double next = std::clamp(asked, -law.limit, law.limit);
    if (law.anti_windup.index == Cascade::back_calculation)
      velocity_integral += law.sample_time * (next - asked) / law.velocity_kp;
    if (law.anti_windup.index == Cascade::clamp && next != asked && asked * (wanted - speed) > 0.0)
      velocity_integral -= law.sample_time * (wanted - speed);
    move(law.computation_delay);
    command = next;
    move(law.sample_time - law.computation_delay);
  }
};

/// Compares y with that of a reference just before each of its samples, in marches by both steppers.
template <class Reference>
void check_samples(const Loop& loop, const LoopState& start, const Reference& at_start, double time, int samples,
                   bool counts = false) {
  for (const StepperKind kind : {StepperKind::exact, StepperKind::rodas5p}) {
    // An error of the integration at the edge between two counts is a count.
    if (counts && kind != StepperKind::exact) continue;
    Reference reference = at_start;
    LoopField field(loop);
    field.modes() = start.modes;
    March march(field, kind, loop_weights(loop, 1e-10));
    march.begin(start.x, 0.0);
    const double tolerance = kind == StepperKind::exact ? 1e-9 : 1e-6;
    for (int k = 1; k <= samples; ++k) {
      INFO("sample " << k << " of stepper " << static_cast<int>(kind));
      reference.period();
      const double t = (k - 1e-6) * time;
      while (march.t() < t) REQUIRE(march.step(t) == Status::converged);
      REQUIRE(field.y(march.x()) == Approx(reference.y).margin(tolerance + 2e-6 * time * std::abs(reference.v)));
    }
    CHECK(march.events() > samples);
  }
}

LoopParts sampled_servo(double time, double delay, double quantum) {
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  Pid& controller = std::get<Pid>(parts.controller);
  controller.sample_time = time;
  controller.computation_delay = delay;
  controller.input_step = quantum;
  return parts;
}

}  // namespace

TEST_CASE("sampled PID with dry friction: position and velocity are those of the closed form, sample for sample") {
  const double delay = GENERATE(0.0, 0.003, 0.01), quantum = GENERATE(0.0, 0.0137);
  const double time = 0.01, y0 = 0.7123;
  INFO("delay " << delay << ", quantum " << quantum);
  for (const int window : {0, 1, 4}) {
    LoopParts parts = sampled_servo(time, delay, quantum);
    std::get<Pid>(parts.controller).velocity_window = window;
    const Loop loop = in_time_domain(build_loop(parts), 1).loop;
    const double e = -rounded_to(quantum, y0);
    const HeldServo servo{{1.5, 1.0, y0, 0.0, 0.0},
                          3.0,
                          4.0,
                          6.0,
                          time,
                          delay,
                          quantum,
                          0.0,
                          std::vector<double>(static_cast<std::size_t>(std::max(window, 1)), e)};
    check_samples(loop, sampled_state(loop, Eigen::Vector3d(y0, 0.0, 0.0)), servo, time, 3000);
  }
}

TEST_CASE("sampled cascade with dry friction: the position is that of the closed form, sample for sample") {
  Cascade law;
  law.position_kp = 1.5;
  law.position_ki = 0.3;
  law.velocity_kp = 6.0;
  law.velocity_ki = 8.0;
  law.sample_time = 0.01;
  law.position_every = GENERATE(1.0, 4.0);
  law.velocity_window = GENERATE(0.0, 1.0, 3.0);
  law.computation_delay = GENERATE(0.0, 0.004, 0.01);
  if (law.position_every > 1.0) {
    law.limit = 3.0;
    law.anti_windup.index = Cascade::back_calculation;
    law.input_step = 0.0031;
  }
  CAPTURE(law.position_every, law.velocity_window, law.computation_delay);
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  parts.controller = law;
  const Loop loop = in_time_domain(build_loop(parts), 1).loop;
  const double y0 = 0.7123;
  const HeldCascade held{
      {1.5, 1.0, y0, 0.0, 0.0},
      law,
      0,
      0.0,
      0.0,
      0.0,
      std::vector<double>(static_cast<std::size_t>(law.velocity_window), rounded_to(law.input_step, y0))};
  check_samples(loop, sampled_state(loop, Eigen::Vector4d(y0, 0.0, 0.0, 0.0)), held, law.sample_time, 1500,
                law.input_step > 0.0);
}

TEST_CASE("clamped cascade: sample for sample, and the continuous one is its limit at first order") {
  Cascade law;
  law.position_kp = 1.5;
  law.velocity_kp = 6.0;
  law.velocity_ki = 40.0;
  law.limit = 2.2;
  law.anti_windup.index = Cascade::clamp;
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  const double y0 = 2.7123;
  const auto held = [&] { return HeldCascade{{1.5, 1.0, y0, 0.0, 0.0}, law, 0, 0.0, 0.0, 0.0, {}}; };
  law.sample_time = 0.01;
  parts.controller = law;
  const Loop sampled = in_time_domain(build_loop(parts), 1).loop;
  check_samples(sampled, sampled_state(sampled, Eigen::Vector3d(y0, 0.0, 0.0)), held(), law.sample_time, 800, true);

  law.sample_time = 0.0;
  parts.controller = law;
  const Loop loop = build_loop(parts);
  for (const StepperKind kind : {StepperKind::exact, StepperKind::rodas5p}) {
    LoopField field(loop);
    State start(static_cast<std::size_t>(field.size()), 0.0);
    start[0] = y0;
    field.start(start, 0.0);
    March march(field, kind, loop_weights(loop, 1e-9));
    march.begin(start, 0.0);
    const double steps[] = {4e-4, 1e-4};
    double apart[2] = {0.0, 0.0};  // summed over some times: where a sample is clamped, it jumps by a share of a step
    for (const double t : {0.6, 1.1, 1.5, 1.9, 2.3, 2.6, 3.2, 4.0}) {
      while (march.t() < t) REQUIRE(march.step(t) == Status::converged);
      for (int k = 0; k < 2; ++k) {
        law.sample_time = steps[k];
        HeldCascade reference = held();
        for (int i = 0; i < static_cast<int>(std::lround(t / law.sample_time)); ++i) reference.period();
        apart[k] += std::abs(reference.y - field.y(march.x()));
      }
    }
    CAPTURE(static_cast<int>(kind), apart[0], apart[1]);
    CHECK(apart[1] < 1e-3);
    CHECK(apart[0] / apart[1] > 2.5);
    CHECK(apart[0] / apart[1] < 6.0);
    if (kind == StepperKind::exact) CHECK(AffineFlow::applies(loop));
  }
}

TEST_CASE("sampled element: it reads at every n-th tick, and a limit is taken off its states") {
  Sampled<double> element;
  element.sample_time = 0.1;
  element.every = 3.0;
  element.D = 1.0;
  element.A = {1.0};
  element.B = {1.0};
  element.C = {2.0};
  element.hold_back = {0.5};
  element.limit = 2.0;
  REQUIRE_FALSE(element.validate());
  double z[4] = {0.0, 0.0, 0.0, 0.0};
  REQUIRE(element.states() == 4);
  const Mode mode = element.start({1.5, 0.0, 0.0}, z);
  CHECK(z[1] == 1.5);
  CHECK(z[2] == 1.5);
  for (int tick = 1; tick < 3; ++tick) {
    element.next({0.7, 0.0, 0.0}, mode, z, 0);
    CHECK(z[1] == 1.5);  // not read
    CHECK(z[0] == 0.1);
  }
  element.next({0.7, 0.0, 0.0}, mode, z, 0);
  CHECK(z[1] == 2.0);  // 0.7 + 2 1.5, limited
  CHECK(z[2] == Approx(1.5 + 0.7 + 0.5 * (2.0 - 3.7)));
  CHECK(element.even_state(3));
  CHECK(element.state_scale(3) == 1.0);
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
  element.computation_delay = 10.1;
  REQUIRE(element.validate().has_value());
  CHECK(element.validate()->key == "computation_delay");
}

TEST_CASE("sampled controller of bristles: what is marched between its samples is as accurate as the tolerance") {
  const double h =
      GENERATE(0.001, 0.02);  // explicit steps are taken between the samples of the first, refused at the second
  CAPTURE(h);
  LoopParts parts = servo_parts(lugre(1.5, 1.0, 0.4));
  std::get<Pid>(parts.controller).sample_time = h;
  const Loop loop = in_time_domain(build_loop(parts), lowest_pade_order).loop;
  constexpr double end = 3.0 + 1.0 / 3.0;
  const auto at_end = [&](StepperKind kind, double rtol) {
    LoopField field(loop);
    State x(field.size(), 0.0);
    x[0] = 0.3;
    field.start(x, 0.0);
    March march(field, kind, loop_weights(loop, rtol));
    march.begin(x, 0.0);
    while (march.t() < end) REQUIRE(march.step(end) == Status::converged);
    return std::pair(field.y(march.x()), march.steps());
  };
  const double exact = at_end(StepperKind::fehlberg78, 1e-12).first;
  double last = infinite;
  for (const double rtol : {1e-5, 1e-7, 1e-9}) {
    CAPTURE(rtol);
    const double error = std::abs(at_end(StepperKind::rodas5p, rtol).first / exact - 1.0);
    CHECK(error < 100.0 * rtol);
    CHECK(error < std::max(0.2 * last, 1e-11));
    last = error;
  }
}
