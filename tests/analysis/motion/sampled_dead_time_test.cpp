// Sampled controllers that read a plant through a dead time, against recursions that keep the past themselves.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <deque>
#include <random>

#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/delay.hpp"
#include "limcycle/tests/loops.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

struct Process {
  double gain = 1.0, time_constant = 5.0, delay = 1.0, kp = 1.0, ki = 0.2, sample_time = 0.2, computation_delay = 0.0;
};

Pid sampled_pi(const Process& of) {
  Pid controller = pid(of.kp, of.ki, 0.0);
  controller.sample_time = of.sample_time;
  controller.computation_delay = of.computation_delay;
  return controller;
}

Loop loop_of(const Process& of, const Element& element) {
  LoopParts parts;
  parts.plant = FirstOrder{of.gain, of.time_constant, of.delay};
  parts.controller = sampled_pi(of);
  parts.element = element;
  return build_loop(parts);
}

/// y of the plant at the end, before its dead time, from y0 and with y0 for all time before: exact exponentials between
/// the instants at which a command comes. A reading at k sample_time sees y of one dead time before.
template <class Element>
double last_of_recursion(const Process& of, const Element& element, double y0, double end) {
  double y = y0, integral = 0.0, t = 0.0, command = 0.0;
  int samples = 0;
  std::deque<std::pair<double, double>> past;  ///< of the plant: time from which on, and y and command there
  std::deque<double> commands;
  std::deque<std::pair<double, double>> waiting;  ///< times of commands, and these
  past.emplace_back(0.0, y0);
  commands.push_back(0.0);
  const auto at = [&](double when) {
    if (when <= 0.0) return y0;
    const auto after = std::ranges::upper_bound(past, when, {}, &std::pair<double, double>::first);
    const auto k = static_cast<std::size_t>(after - past.begin()) - 1;
    const double rest = of.gain * commands[k];
    return rest + (past[k].second - rest) * std::exp(-(when - past[k].first) / of.time_constant);
  };
  const auto go = [&](double to) {
    const double rest = of.gain * command;
    y = rest + (y - rest) * std::exp(-(to - t) / of.time_constant);
    t = to;
  };
  const auto put_out_until = [&](double when) {
    for (; !waiting.empty() && waiting.front().first <= when; waiting.pop_front()) {
      go(std::max(t, waiting.front().first));
      command = waiting.front().second;
      past.emplace_back(t, y);
      commands.push_back(command);
    }
  };
  for (double tick = 0.0; tick <= end; tick = ++samples * of.sample_time) {
    put_out_until(tick);
    const double e = -at(tick - of.delay);
    integral += of.sample_time * e;
    waiting.emplace_back(tick + of.computation_delay, element(of.kp * e + of.ki * integral));
  }
  put_out_until(end);
  go(end);
  return y;
}

double last_of_simulation(const Loop& loop, double y0, double end) {
  SimulateOptions options;
  options.duration = options.sample = end;
  options.initial = {{"x1", y0}};
  const Simulation run = simulate(loop, options);
  INFO(run.why);
  REQUIRE(run.status == Status::converged);
  const auto column = std::ranges::find(run.columns, "y") - run.columns.begin();
  return run.rows.back()[static_cast<std::size_t>(column)];
}

}  // namespace

TEST_CASE("dead time before a sampled controller: exact, for any number of samples within it") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  const auto limited = [](double u) { return std::clamp(u, -0.7, 0.7); };
  for (int k = 0; k < samples(20); ++k) {
    Process of;
    of.sample_time = 0.05 + part(random);
    of.computation_delay = k % 2 == 0 ? 0.0 : (k % 3 == 0 ? 1.0 : 4.0 * part(random)) * of.sample_time;
    // Also a whole number of samples, where each reading coincides with a command.
    of.delay = k % 3 == 0 ? (1 + k) * of.sample_time : 3.0 * part(random);
    of.kp = 2.0 * part(random);
    of.ki = 0.5 * part(random);
    const double y0 = 2.0 * part(random) - 1.0, end = 20.0 + part(random);
    INFO("sample_time " << of.sample_time << ", delay " << of.delay << ", computation " << of.computation_delay);
    const Loop loop = loop_of(of, saturation(0.7));
    CHECK(in_time_domain(loop, lowest_pade_order).pade_order == 0);
    CHECK(last_of_simulation(loop, y0, end) == Approx(last_of_recursion(of, limited, y0, end)).margin(1e-9));
  }
}

TEST_CASE("dead time before a sampled controller: its response is that without, behind the dead time") {
  Process of;
  of.computation_delay = 0.07;
  of.delay = 0.0;
  const Loop without = loop_of(of, saturation(1.0));
  of.delay = 0.93;
  const Loop with = loop_of(of, saturation(1.0));
  for (const double w : {0.1, 1.0, 7.0}) {
    const auto expected = std::polar(1.0, -w * of.delay) * without.element_response(w)(0, 0);
    CHECK(std::abs(with.element_response(w)(0, 0) - expected) < 1e-12 * std::abs(expected));
  }
}

TEST_CASE("relay with sampling and dead time: locked cycles of closed form, and the integral is remembered") {
  // Between two commands the plant tends to +-gain: y = gain tanh(period/(4 time_constant)) at its turns, the period
  // being an even number of samples. Deviations of y decay with the plant.
  for (const double ki : {0.0, 0.2})
    for (const auto& [delay, computation] :
         {std::pair(0.0, 0.0), {0.93, 0.0}, {1.0, 0.0}, {0.0, 0.07}, {0.93, 0.07}, {0.0, 0.2}, {0.93, 0.5}}) {
      Process of;
      of.ki = ki;
      of.delay = delay;
      of.computation_delay = computation;
      INFO("ki " << ki << ", delay " << delay << ", computation " << computation);
      const PredictReport report = predict(loop_of(of, relay(1.0)), {});
      REQUIRE_FALSE(report.cycles.empty());
      for (const OutcomeOfStart& one : report.outcomes) CHECK(one.outcome == Outcome::cycle);
      for (const Cycle& cycle : report.cycles) {
        const double pairs = cycle.period / (2.0 * of.sample_time);
        CHECK(pairs == Approx(std::round(pairs)).epsilon(1e-10));
        CHECK(cycle.amplitude == Approx(std::tanh(cycle.period / (4.0 * of.time_constant))).epsilon(1e-9));
        CHECK(cycle.stable == true);
        CHECK(cycle.remembered == (ki > 0.0 ? 1 : 0));
        REQUIRE_FALSE(cycle.multipliers.empty());
        CHECK(std::abs(cycle.multipliers[0] - std::exp(-cycle.period / of.time_constant)) < 1e-6);
      }
    }
}

TEST_CASE("sampled PID: its derivative begins with the readings that the start stands for, behind a dead time too") {
  // A mass without friction to speak of: exact between commands, which differences of the past y give.
  constexpr double kp = 3.0, ki = 1.0, kd = 2.5, T = 0.05, y0 = 0.3;
  for (const int late : {0, 3}) {
    Pid controller = pid(kp, ki, kd);
    controller.sample_time = T;
    Diagram diagram;
    diagram.output = {1.0, "axis", "y"};
    diagram.blocks.push_back({"axis", "diagram.axis", Plant(Mass{1.0, 0.0, 0.0}), {{{1.0, "pid", ""}}}});
    const std::string read = late > 0 ? "late" : "axis";
    if (late > 0)
      diagram.blocks.push_back({"late", "diagram.late", LinearBlock(DelayBlock{late * T}), {{{1.0, "axis", "y"}}}});
    diagram.blocks.push_back({"pid", "diagram.pid", Controller(controller), {{{1.0, "r", ""}, {-1.0, read, ""}}}});
    diagram.blocks.push_back({"friction", "diagram.friction", coulomb(1e-14, 1e-14), {}, Contact::opposes, "axis"});
    LoopParts parts;
    parts.diagram = diagram;
    REQUIRE_FALSE(validate(parts));
    double y = y0, v = 0.0, integral = 0.0, last = -y0;
    std::deque<double> past(static_cast<std::size_t>(late) + 1, y0);  // the first is the one that is read
    constexpr int steps = 40;
    for (int k = 0; k < steps; ++k) {
      past.back() = y;
      const double e = -past.front();
      integral += T * e;
      const double u = kp * e + ki * integral + kd * (e - last) / T;
      last = e;
      past.pop_front();
      past.push_back(0.0);
      y += T * v + 0.5 * T * T * u;
      v += T * u;
    }
    SimulateOptions options;
    options.duration = options.sample = steps * T;
    options.initial = {{"axis.y", y0}};
    const Simulation run = simulate(build_loop(parts), options);
    REQUIRE(run.status == Status::converged);
    const auto column = std::ranges::find(run.columns, "y") - run.columns.begin();
    INFO("late by " << late << " samples");
    CHECK(run.rows.back()[static_cast<std::size_t>(column)] == Approx(y).margin(1e-9));
  }
}

TEST_CASE("dead time before a sampled controller: in the plant or as a block of its own, the cycles are the same") {
  Process of;
  of.ki = 0.0;
  Diagram diagram;
  diagram.output = {1.0, "process", "y"};
  diagram.blocks.push_back({"process", "diagram.process", Plant(FirstOrder{1.0, 5.0, 0.0}), {{{1.0, "valve", ""}}}});
  diagram.blocks.push_back({"late", "diagram.late", LinearBlock(DelayBlock{1.0}), {{{1.0, "process", "y"}}}});
  diagram.blocks.push_back({"pi", "diagram.pi", Controller(sampled_pi(of)), {{{1.0, "r", ""}, {-1.0, "late", ""}}}});
  diagram.blocks.push_back({"valve", "diagram.valve", Element(relay(1.0)), {{{1.0, "pi", ""}}}});
  LoopParts parts;
  parts.diagram = diagram;
  const PredictReport one = predict(loop_of(of, relay(1.0)), {}), other = predict(build_loop(parts), {});
  REQUIRE(one.cycles.size() == 1);
  REQUIRE(other.cycles.size() == 1);
  CHECK(other.cycles[0].period == Approx(one.cycles[0].period).epsilon(1e-10));
  CHECK(other.cycles[0].amplitude == Approx(one.cycles[0].amplitude).epsilon(1e-10));
}
