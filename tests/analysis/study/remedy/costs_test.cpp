#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/energy/loop/stuck_set.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/study/remedy/actuator_travel.hpp"
#include "limcycle/analysis/study/remedy/linear_costs.hpp"
#include "limcycle/analysis/study/remedy/rest_range.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/element/memoryless/quantizer.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using limcycle::test::coulomb;
using limcycle::test::lugre;
using limcycle::test::pid;
using limcycle::test::servo_parts;
using Complex = std::complex<double>;

namespace {

LoopParts position_loop(double kp, double ki, double kd, double load = 0.0) {
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  parts.controller = pid(kp, ki, kd);
  parts.load = load;
  return parts;
}

DeadZone<double> dead_zone(double half_width) {
  DeadZone<double> element;
  element.half_width = half_width;
  return element;
}

void check_range(const LoopParts& parts, double low, double high) {
  const auto range = rest_range(build_loop(parts));
  REQUIRE(range);
  CHECK(range->low == Approx(low).margin(1e-9));
  CHECK(range->high == Approx(high).margin(1e-9));
}

}  // namespace

TEST_CASE("rest range: a friction compensation holds its share of the level with the friction, and no more") {
  LoopParts parts = position_loop(100.0, 0.0, 10.0);
  Pid& controller = std::get<Pid>(parts.controller);
  for (const double compensation : {0.6, 1.2, 1.95}) {  // of Fc; at break-away the friction holds with Fs
    controller.friction_compensation = compensation;
    const double most = std::abs(1.5 - compensation * 1.0) / 100.0;
    CAPTURE(compensation);
    check_range(parts, -most, most);
  }
}

TEST_CASE("rest range: the stuck states of a linear loop, as stuck_set finds them") {
  check_range(position_loop(3.0, 0.0, 6.0), -0.5, 0.5);       // Fs/kp
  check_range(position_loop(3.0, 0.0, 6.0, 0.3), -0.4, 0.6);  // (load -+ Fs)/kp
  check_range(position_loop(3.0, 4.0, 6.0), 0.0, 0.0);        // the integral stands still at e = 0 only
  for (const double kp : {0.7, 3.0, 250.0}) {
    const Loop loop = build_loop(position_loop(kp, 0.0, 6.0, -0.2));
    const auto range = rest_range(loop);
    const StuckSet stuck = stuck_set(loop, {.march = false, .stop = {}});
    REQUIRE(range);
    CHECK(range->low == Approx(stuck.output.low).epsilon(1e-9));
    CHECK(range->high == Approx(stuck.output.high).epsilon(1e-9));
  }
}

TEST_CASE("rest range: a dead zone and a limit widen it by what they hide") {
  LoopParts parts = position_loop(3.0, 4.0, 6.0);
  parts.error = dead_zone(0.1);
  check_range(parts, -0.1, 0.1);  // wherever the integral sees nothing
  parts.controller = pid(3.0, 0.0, 6.0);
  check_range(parts, -0.6, 0.6);  // h + Fs/kp
  parts = position_loop(3.0, 0.0, 6.0);
  std::get<Pid>(parts.controller).saturation = 2.0;
  check_range(parts, -0.5, 0.5);
  std::get<Pid>(parts.controller).saturation = 1.0;  // too weak to break away: it rests anywhere
  const auto anywhere = rest_range(build_loop(parts));
  REQUIRE(anywhere);
  CHECK(std::isinf(anywhere->low));
  CHECK(std::isinf(anywhere->high));
}

TEST_CASE("rest range: an integral that is limited, or frozen outside a band, leaves an error") {
  LoopParts parts = position_loop(3.0, 4.0, 6.0);
  std::get<Pid>(parts.controller).integral_limit = 0.9;
  check_range(parts, -0.2, 0.2);  // clamped at the limit: (Fs - limit)/kp
  std::get<Pid>(parts.controller).integral_limit = 2.0;
  check_range(parts, 0.0, 0.0);  // it breaks the body loose from anywhere else
  parts = position_loop(3.0, 4.0, 6.0);
  std::get<Pid>(parts.controller).integral_band = 0.1;
  const auto range = rest_range(build_loop(parts));  // outside the band any error meets an integral that holds it
  REQUIRE(range);
  CHECK(std::isinf(range->low));
  CHECK(std::isinf(range->high));
}

TEST_CASE("rest range: relays without friction rest where they do not switch") {
  const auto check = [](Relay<double> relay, double gain, double most) {
    const auto range = rest_range(test::forward(relay, {gain}, {1.0, 3.0, 3.0, 1.0}));
    REQUIRE(range);
    CHECK(range->low == Approx(-most).margin(1e-9));
    CHECK(range->high == Approx(most).margin(1e-9));
  };
  check(test::relay(1.0), 6.0, 0.0);            // it holds the input at 0
  check(test::relay(1.0, 7.0), 6.0, 6.0);       // on for ever: the output 6 does not reach the hysteresis
  check(test::relay(1.0, 0.0, 0.5), 6.0, 0.0);  // off
  const auto none = rest_range(test::forward(test::relay(1.0, 2.0), {6.0}, {1.0, 3.0, 3.0, 1.0}));
  CHECK_FALSE(none);  // it switches wherever it stands
}

TEST_CASE("rest range: no answer where nothing rests or an element is of another kind") {
  CHECK_FALSE(rest_range(test::belt(lugre())));  // it slides
  Quantizer<double> quantizer;
  quantizer.step = 0.1;
  CHECK_FALSE(rest_range(test::forward(quantizer, {1.0}, {1.0, 3.0, 3.0, 1.0})));
}

TEST_CASE("linear costs: margins of a mass under PD control, in closed form") {
  for (const double m : {1.0, 0.02}) {
    LoopParts parts = position_loop(3.0 * m, 0.0, 6.0 * m);
    parts.plant = Mass{m, 0.0, 0.0};
    const LinearCosts costs = linear_costs(parts, 1.0);
    REQUIRE(costs.stable);
    const double kp = 3.0, kd = 6.0;  // |kp + j kd w| = w^2
    const double w = std::sqrt(0.5 * (kd * kd + std::sqrt(kd * kd * kd * kd + 4.0 * kp * kp)));
    const double phase = std::atan2(kd * w, kp);
    CHECK(costs.phase_margin.value() == Approx(phase).epsilon(1e-9));
    CHECK(costs.delay_margin.value() == Approx(phase / w).epsilon(1e-9));
    CHECK(std::isinf(costs.noise_gain.value()));  // a derivative without a filter
    // S = s^2/(s^2 + kd s + kp) does not exceed 1 for such damping.
    CHECK(costs.peak_sensitivity.value() == Approx(1.0).epsilon(1e-4));
    // Overdamped from rest: y = (s1 exp(s2 t) - s2 exp(s1 t))/(s1 - s2).
    CHECK(costs.overshoot.value() == Approx(0.0).margin(1e-9));
    const double root = std::sqrt(kd * kd / 4.0 - kp), s1 = -kd / 2.0 + root, s2 = -kd / 2.0 - root;
    const double t = costs.settling_time.value();
    const auto y = [&](double at) { return (s1 * std::exp(s2 * at) - s2 * std::exp(s1 * at)) / (s1 - s2); };
    CHECK(std::abs(y(t)) == Approx(0.02).epsilon(0.01));
  }
}

TEST_CASE("linear costs: sensitivity and noise gain of a filtered PID with a dead time, against a plain grid") {
  LoopParts parts = position_loop(3.0, 4.0, 6.0);
  auto& controller = std::get<Pid>(parts.controller);
  controller.tf = 0.02;
  controller.lag = 0.005;
  const LinearCosts costs = linear_costs(parts, 1.0);
  REQUIRE(costs.stable);
  double peak = 0.0, noise = 0.0;
  for (int i = 0; i <= 200000; ++i) {
    const Complex s(0.0, 1e-3 * std::pow(10.0, 8.0 * i / 200000.0));
    const Complex C = (3.0 + 4.0 / s + 6.0 * s / (0.02 * s + 1.0)) / (0.005 * s + 1.0), L = C / (s * s);
    peak = std::max(peak, 1.0 / std::abs(1.0 + L));
    noise = std::max(noise, std::abs(C / (1.0 + L)));
  }
  CHECK(costs.peak_sensitivity.value() == Approx(peak).epsilon(1e-6));
  CHECK(costs.noise_gain.value() == Approx(noise).epsilon(1e-6));
}

TEST_CASE("linear costs: a sampled derivative passes noise up to half the sampling frequency only") {
  LoopParts parts = position_loop(3.0, 0.0, 6.0);
  std::get<Pid>(parts.controller).sample_time = 0.01;
  const LinearCosts costs = linear_costs(parts, 1.0);
  REQUIRE(costs.stable);
  const Complex s(0.0, std::numbers::pi / 0.01), C = 3.0 + 6.0 * s, L = C / (s * s) * std::exp(-0.005 * s);
  CHECK(costs.noise_gain.value() == Approx(std::abs(C / (1.0 + L))).epsilon(1e-6));
}

TEST_CASE("linear costs: an element that changes the gain leaves them unknown") {
  LoopParts parts = position_loop(3.0, 0.0, 6.0);
  auto half = dead_zone(0.1);
  half.slope = 0.5;
  parts.error = half;
  CHECK_FALSE(linear_costs(parts, 1.0).stable);
  CHECK_FALSE(linear_costs(parts, 1.0).phase_margin);
}

TEST_CASE(
    "linear costs: of a loop that is unstable without friction nothing is given, nor of one without a controller") {
  CHECK_FALSE(linear_costs(position_loop(3.0, 40.0, 6.0), 1.0).stable);  // ki m > kp kd
  std::string why;
  LoopParts belt;
  belt.plant = Belt{1.0, 2.0, 0.0, 0.1};
  belt.friction = lugre();
  CHECK_FALSE(open_loop(belt, why));
  CHECK(why == "there is no controller");
}

TEST_CASE("step numbers: the last time outside 2 % and the largest swing beyond zero") {
  // y = 2 cos(t) e^(-t/2) with its rate, in steps of half a turn at most: its crossings and turns lie between samples.
  Trace run;
  for (int i = 0; i <= 400; ++i) {
    const double t = 5.0 + 0.1 * i, since = t - 5.0, decay = 2.0 * std::exp(-0.5 * since);
    run.t.push_back(t);
    run.y.push_back(decay * std::cos(since));
    run.rate.push_back(-decay * (0.5 * std::cos(since) + std::sin(since)));
  }
  const StepNumbers numbers = step_numbers(run, 2.0);
  const auto share = [](double t) { return std::exp(-0.5 * t) * std::cos(t); };
  const double turn = std::numbers::pi - std::atan(0.5);
  CHECK(numbers.overshoot == Approx(-share(turn)).epsilon(1e-5));
  CHECK(std::abs(share(numbers.settling_time)) == Approx(0.02).epsilon(1e-5));
  for (int i = 0; i < 40'000; ++i) REQUIRE(std::abs(share(numbers.settling_time + 1e-6 + 1e-3 * i)) < 0.02);
  CHECK(step_numbers({}, 1.0).overshoot == 0.0);
}

TEST_CASE("step numbers: of a servo that slews at the limit of its command, as counted step by step") {
  // 1 kg with 2 N s/m under 400 e - 40 v, limited to 1 N: 0.4 m/s at most.
  for (const double step : {0.5, 20.0}) {
    Pid controller = pid(400.0, 0.0, 40.0);
    controller.saturation = 1.0;
    LoopParts parts;
    parts.plant = Mass{1.0, 2.0, 0.0};
    parts.controller = controller;
    parts.friction = coulomb(0.4, 0.2, 0.0);
    const Loop loop = build_loop(parts);
    const Settled run = settle(loop, displaced(loop, step), {});
    constexpr double h = 1e-4;
    double y = step, v = 0.0, last = 0.0;
    for (int i = 0; i < 800'000; ++i) {
      const double u = std::clamp(-400.0 * y - 40.0 * v, -1.0, 1.0);
      const double next = v + h * (u - 2.0 * v - (v == 0.0 ? std::clamp(u, -0.4, 0.4) : std::copysign(0.2, v)));
      v = next * v < 0.0 ? 0.0 : next;
      y += h * v;
      if (std::abs(y) > 0.02 * step) last = h * i;
    }
    CHECK(step_numbers(run.trace, step).settling_time == Approx(last).epsilon(2e-3));
  }
}

TEST_CASE("step numbers: a limit of the command that is not reached changes no start, however the integral leaks") {
  LoopParts parts = position_loop(400.0, 60.0, 40.0);
  auto& controller = std::get<Pid>(parts.controller);
  controller.leak = 0.05;
  const LoopState free = displaced(build_loop(parts), 0.3);
  controller.saturation = 1e6;
  const LoopState limited = displaced(build_loop(parts), 0.3);
  REQUIRE(limited.x.size() == free.x.size());
  for (std::size_t i = 0; i < free.x.size(); ++i) CHECK(limited.x[i] == Approx(free.x[i]).margin(1e-9));
}

TEST_CASE("rest range: impulses leave the error within their band, a reset at a stop none") {
  LoopParts parts = position_loop(3.0, 0.0, 6.0);
  auto& controller = std::get<Pid>(parts.controller);
  controller.impulse = 2.0;
  controller.impulse_width = 0.1;
  controller.impulse_pause = 0.5;
  controller.impulse_band = 0.02;
  controller.impulse_speed = 1e-3;
  check_range(parts, -0.02, 0.02);
  controller = pid(3.0, 4.0, 6.0);
  controller.integral_reset = 1.0;
  controller.reset_speed = 1e-3;
  check_range(parts, 0.0, 0.0);
  controller = pid(3.0, 4.0, 6.0);
  controller.integral_dead_zone = 0.02;
  check_range(parts, -0.02, 0.02);
  controller.integral_hysteresis = 0.01;
  check_range(parts, -0.03, 0.03);
}

TEST_CASE("actuator travel: that of a proportional command is kp times the way of y, in two units of length") {
  for (const double unit : {1.0, 1e-3}) {
    LoopParts parts = servo_parts(coulomb(0.15, 0.1));
    parts.plant = Mass{1.0 / unit, 0.0, 0.0};
    parts.controller = pid(3.0 / unit, 0.0, 0.0);
    SimulateOptions run;
    run.duration = 60.0;
    run.rtol = 1e-9;
    run.sample = 1e-2;
    run.initial = {{"y", unit}};
    const Simulation seen = simulate(build_loop(parts), run);
    double way = 0.0;
    for (std::size_t i = 1; i < seen.trace.y.size(); ++i) way += std::abs(seen.trace.y[i] - seen.trace.y[i - 1]);
    CHECK(actuator_travel(parts, unit, 60.0).value() == Approx(3.0 / unit * way).epsilon(1e-4));
  }
}

TEST_CASE("actuator travel: impulses count up and down, and where the command is not a row of numbers there is none") {
  LoopParts parts = servo_parts(coulomb(1.0, 1.0));
  Pid controller = pid(0.0, 0.0, 0.0);
  controller.impulse = 3.0;
  controller.impulse_width = 0.1;
  controller.impulse_pause = 0.5;
  controller.impulse_band = 0.02;
  controller.impulse_speed = 1e-3;
  parts.plant = Mass{2.0, 0.0, 0.0};
  parts.controller = controller;
  CHECK(actuator_travel(parts, 0.1, 20.0).value() == Approx(6 * 2 * 3.0).epsilon(1e-12));  // six hops of 0.015 m
  controller = pid(3.0, 0.0, 6.0);
  controller.sample_time = 0.01;
  parts.controller = controller;
  CHECK_FALSE(actuator_travel(parts, 0.1, 20.0));
}
