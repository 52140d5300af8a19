#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/analysis/study/predict/verdicts.hpp"
#include "limcycle/models/delay.hpp"
#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/models/element/memoryless/saturation.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// 1/(s + 1)^3 under a relay whose input is read every `h`, in closed form from sample to sample.
struct SampledRelay {
  double h, x1 = 0.0, x2 = 0.0, x3 = 0.0;

  void move(double u, double time) {
    const double fade = std::exp(-time), d1 = x1 - u, d2 = x2 - u, d3 = x3 - u;
    x1 = u + fade * d1;
    x2 = u + fade * (d2 + time * d1);
    x3 = u + fade * (d3 + time * d2 + 0.5 * time * time * d1);
  }
  /// Samples of a period and half the swing, once the transient has died out.
  std::pair<int, double> settled(double start) {
    constexpr int parts = 50;
    x1 = x2 = x3 = start;
    double low = infinite, high = -infinite;
    std::vector<int> rises;
    for (int k = 0; k < 4000; ++k) {
      const double u = x3 > 0.0 ? -1.0 : 1.0, before = x3;
      for (int part = 0; part < parts; ++part) {
        move(u, h / parts);
        if (k < 3000) continue;
        low = std::min(low, x3);
        high = std::max(high, x3);
      }
      if (k >= 3000 && before <= 0.0 && x3 > 0.0) rises.push_back(k);
    }
    const int period = rises.at(1) - rises.at(0);
    for (std::size_t i = 1; i < rises.size(); ++i) REQUIRE(rises[i] - rises[i - 1] == period);
    return {period, 0.5 * (high - low)};
  }
};

Loop relay_at(double sample_time) {
  Relay<double> relay;
  relay.level = 1.0;
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 3.0, 3.0, 1.0}, 0.0};
  NoController controller;
  controller.sample_time = sample_time;
  parts.controller = controller;
  parts.element = relay;
  return build_loop(parts);
}

LoopParts servo_at(double sample_time, double ki = 4.0) {
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  Pid& controller = std::get<Pid>(parts.controller);
  controller.ki = ki;
  controller.sample_time = sample_time;
  return parts;
}

Settled settled(const Loop& in_time, double displacement) {
  return settle(in_time, displaced(in_time, displacement), SettleOptions{});
}

}  // namespace

TEST_CASE("sampled relay: every stable cycle is that of the recursion, a whole number of samples") {
  const double h = GENERATE(0.05, 0.1, 0.237, 0.41);
  INFO("sample time " << h);
  const PredictReport report = predict(relay_at(h));
  REQUIRE(!report.cycles.empty());
  std::set<int> periods;
  for (const Cycle& cycle : report.cycles) {
    if (cycle.stable != true) continue;
    const double samples = cycle.period / h;
    CHECK(samples == Approx(std::round(samples)).epsilon(1e-9));
    periods.insert(static_cast<int>(std::lround(samples)));
  }
  for (const double start : {10.0, 1.0, 0.01}) {
    const auto [period, amplitude] = SampledRelay{h}.settled(start);
    INFO("start " << start << ", " << period << " samples");
    const auto found = std::ranges::find_if(
        report.cycles, [&, period = period](const Cycle& cycle) { return std::lround(cycle.period / h) == period; });
    REQUIRE(found != report.cycles.end());
    CHECK(found->amplitude == Approx(amplitude).epsilon(1e-3));
    CHECK(periods.contains(period));
  }
}

TEST_CASE("sampled relay: by the instants of its samples a root moves as by half a sample more or less of dead time") {
  // A = 4/pi |G| where three lags, the hold and that dead time turn by pi, in closed form.
  const double h = GENERATE(0.02, 0.1);
  const auto root = [&](double late) {
    double low = 0.1, high = 1.8;
    for (int i = 0; i < 100; ++i) {
      const double w = 0.5 * (low + high);
      (3.0 * std::atan(w) + w * (0.5 * h + late) < M_PI ? low : high) = w;
    }
    return std::pair(low, 4.0 / M_PI * std::pow(1.0 + low * low, -1.5));
  };
  const PredictReport report = predict(relay_at(h));
  REQUIRE(report.predictions.size() == 1);
  const Prediction& one = report.predictions.front();
  const auto [w, A] = root(0.0);
  const auto [slow, large] = root(0.5 * h);
  const auto [fast, small] = root(-0.5 * h);
  CHECK(one.frequency == Approx(w).epsilon(1e-9));
  CHECK(one.amplitude == Approx(A).epsilon(1e-9));
  REQUIRE(one.sampling);
  CHECK(one.sampling->frequency == Approx(0.5 * std::log(fast / slow)).epsilon(0.1 * h));
  CHECK(one.sampling->amplitude == Approx(0.5 * std::log(large / small)).epsilon(0.1 * h));
  // The cycles that lock lie within it, but for what the describing function is off by without samples (1.5 %).
  for (const Cycle& cycle : report.cycles)
    if (cycle.stable == true) CHECK(std::abs(std::log(cycle.frequency() / w)) < one.sampling->frequency + 0.02);
}

namespace {

/// d2y/dt2 = 0.3 v - 0.3 v^3 - y + u, u = -0.2 y read every 0.7 s: van der Pol's (Rayleigh's) oscillator, whose period
/// is no whole number of samples.
Loop sampled_oscillator() {
  Cubic<double> bend;
  bend.coefficient = 0.3;
  Block gain{"gain", "diagram.gain", LinearBlock(Gain{-0.2}), {{{1.0, "axis", "y"}}}};
  gain.sampling.sample_time = 0.7;
  LoopParts parts;
  Diagram& diagram = parts.diagram.emplace();
  diagram.blocks = {{"axis", "diagram.axis", Plant(Mass{1.0, -0.3, 1.0}), {{{1.0, "gain", ""}, {-1.0, "bend", ""}}}},
                    {"bend", "diagram.bend", Element(bend), {{{1.0, "axis", "v"}}}},
                    gain};
  diagram.output = {1.0, "axis", "y"};
  diagram.load_on = "axis";
  return build_loop(parts);
}

/// Mean time between upward crossings of zero, by Runge-Kutta steps of 1/200 sample after 100 swings.
double oscillator_period() {
  constexpr double h = 0.7 / 200.0;
  double y = 1.0, v = 0.0, u = 0.0, first = 0.0, last = 0.0;
  int rises = 0;
  for (int i = 0; i < 200'000; ++i) {
    if (i % 200 == 0) u = -0.2 * y;
    const auto rate = [&](double at, double speed) { return 0.3 * speed * (1.0 - speed * speed) - at + u; };
    const double k1 = rate(y, v), v2 = v + 0.5 * h * k1, k2 = rate(y + 0.5 * h * v, v2), v3 = v + 0.5 * h * k2,
                 k3 = rate(y + 0.5 * h * v2, v3), v4 = v + h * k3, k4 = rate(y + h * v3, v4), before = y;
    y += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
    v += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    if (!(before < 0.0 && y >= 0.0) || i < 100'000) continue;
    last = h * (i + before / (before - y));
    if (rises++ == 0) first = last;
  }
  return (last - first) / (rises - 1);
}

}  // namespace

TEST_CASE(
    "sampled oscillator: a torus, with its mean period and its beat, and what a prediction of its mean is worth") {
  const double period = oscillator_period(), turns = period / 0.7, beat = 2.0 * M_PI * std::abs(turns - 8.0) / period;
  const PredictReport report = predict(sampled_oscillator(), {});
  CHECK(report.cycles.empty());
  REQUIRE_FALSE(report.outcomes.empty());
  for (const OutcomeOfStart& one : report.outcomes) {
    REQUIRE(one.outcome == Outcome::irregular);
    const IrregularMotion& motion = one.irregular;
    CHECK(motion.mean_period == Approx(period).epsilon(1e-4));
    const double error = 2.0 * M_PI * (motion.longest_period - motion.shortest_period) / (0.7 * motion.observed);
    CHECK(std::abs(motion.beat_frequency - beat) <= error);
    CHECK(error < 1e-3 * beat);
  }
  const auto df = std::ranges::find(report.predictions, "describing-function", &Prediction::method);
  REQUIRE(df != report.predictions.end());
  CHECK(df->verdict == Verdict::confirmed);  // within 5 % of the mean
  REQUIRE(df->motion);
  CHECK(df->frequency == Approx(2.0 * M_PI / period).epsilon(0.02));
  CHECK_FALSE(df->cycle);
  CHECK_THAT(df->why, Catch::Contains("locked to no sample"));
}

TEST_CASE("a prediction is compared with a motion that has no period within the reach of a cycle") {
  IrregularMotion motion;
  motion.mean_amplitude = 2.0;
  motion.mean_period = M_PI;  // 2 rad/s
  Prediction one;
  one.amplitude = 2.05;
  one.frequency = 1.95;
  CHECK(compare(one, motion));
  CHECK(one.verdict == Verdict::confirmed);
  one.amplitude = 3.0;
  CHECK(compare(one, motion));
  CHECK(one.verdict == Verdict::biased);
  CHECK_THAT(one.why, Catch::Contains("amplitude +50 %, frequency -2.5 %"));
  Prediction far;
  far.amplitude = 21.0;
  far.frequency = 2.0;
  CHECK_FALSE(compare(far, motion));
  CHECK_FALSE(far.motion);
  far.amplitude = 2.0;
  far.frequency = 6.1;
  CHECK_FALSE(compare(far, motion));
}

TEST_CASE("sampled servo: its mean period tends to that of the continuous one, and its first-order change is known") {
  const auto continuous = settled(build_loop(servo_at(0.0)), 0.5);
  REQUIRE(continuous.shot);
  const double T0 = continuous.shot->cycle.period;
  for (const double h : {0.08, 0.04, 0.02}) {
    INFO("sample time " << h);
    const Loop loop = build_loop(servo_at(h));
    const auto sampled = settled(in_time_domain(loop, 1).loop, 0.5);
    REQUIRE(sampled.outcome == Outcome::irregular);
    Loop averaged = loop;
    averaged.sampled.reset();
    const auto mean = settled(in_time_domain(averaged, 2).loop, 0.5);
    REQUIRE(mean.shot);
    const double T = sampled.irregular.mean_period, average = mean.shot->cycle.period;
    CAPTURE(T0, T, average, sampled.irregular.shortest_period, sampled.irregular.longest_period);
    CHECK(average - T0 == Approx(18.9 * h).epsilon(0.02));  // of first order
    CHECK(std::abs(T - average) < 0.25 * std::abs(average - T0));
    CHECK(std::abs(T - average) < 60.0 * h * h);
    CHECK(sampled.irregular.shortest_period <= T);
    CHECK(sampled.irregular.longest_period >= T);
    CHECK(sampled.irregular.longest_period - sampled.irregular.shortest_period < 40.0 * h);
  }
}

TEST_CASE("sampled cascade: its mean period tends to that of the continuous one as its average does") {
  const auto at = [](double h) {
    Cascade law;
    law.position_kp = 1.0;
    law.velocity_kp = 4.0;
    law.velocity_ki = 6.0;
    if (h > 0.0) {
      law.sample_time = h;
      law.position_every = 4.0;
      law.velocity_window = 2.0;
      law.computation_delay = 0.5 * h;
    }
    LoopParts parts = servo_parts(coulomb(1.5, 1.0));
    parts.controller = law;
    return build_loop(parts);
  };
  const auto continuous = settled(at(0.0), 0.03);
  REQUIRE(continuous.shot);
  const double T0 = continuous.shot->cycle.period;
  double before = infinite;
  for (const double h : {0.04, 0.02, 0.01}) {
    INFO("sample time " << h);
    const Loop loop = at(h);
    const auto sampled = settled(in_time_domain(loop, 1).loop, 0.03);
    REQUIRE(sampled.outcome == Outcome::irregular);
    Loop averaged = loop;
    averaged.sampled.reset();
    const auto mean = settled(in_time_domain(averaged, 2).loop, 0.03);
    REQUIRE(mean.shot);
    const double T = sampled.irregular.mean_period, average = mean.shot->cycle.period;
    CAPTURE(T0, T, average);
    CHECK(std::abs(T - average) < 0.25 * std::abs(average - T0));
    CHECK(std::abs(T - average) < 0.7 * before);
    before = std::abs(T - average);
  }
}

TEST_CASE("sampled servo: without integral action it comes to rest, and within a count of its encoder too") {
  const PredictReport report = predict(build_loop(servo_at(0.02, 0.0)));
  CHECK(report.cycles.empty());
  for (const OutcomeOfStart& one : report.outcomes) CHECK(one.outcome == Outcome::rest);

  LoopParts parts = servo_at(0.02);
  std::get<Pid>(parts.controller).input_step = 0.1;
  const Loop loop = in_time_domain(build_loop(parts), 1).loop;
  const Settled within = settled(loop, 0.04), outside = settled(loop, 0.06);
  CHECK(within.outcome == Outcome::rest);
  CHECK(within.trace.y.back() == 0.04);
  CHECK(outside.outcome == Outcome::rest);
  CHECK(std::abs(outside.trace.y.back()) < 0.05);
}

TEST_CASE("sampled servo: a moved set-point moves the motion and nothing else") {
  LoopParts parts = servo_at(0.04);
  const auto here = settled(in_time_domain(build_loop(parts), 1).loop, 0.5);
  parts.reference = 7.25;
  const auto there = settled(in_time_domain(build_loop(parts), 1).loop, 0.5);
  CHECK(there.outcome == here.outcome);
  CHECK(there.irregular.mean_period == Approx(here.irregular.mean_period).epsilon(0.01));
  CHECK(there.irregular.half_range == Approx(here.irregular.half_range).epsilon(0.03));
}

TEST_CASE("sampled controller: what does not go together is refused with a reason") {
  LoopParts parts = servo_at(0.01);
  Pid& controller = std::get<Pid>(parts.controller);
  controller.computation_delay = 1.001;
  CHECK(validate(parts)->key == "loop.controller.computation_delay");
  controller = Pid{};
  controller.input_step = 1.0;
  CHECK(validate(parts)->key == "loop.controller.input_step");
  Cascade cascade;
  cascade.position_kp = cascade.velocity_kp = 1.0;
  cascade.position_every = 4.0;
  parts.controller = cascade;
  CHECK(validate(parts)->key == "loop.controller.position_every");
  cascade.sample_time = 0.01;
  cascade.velocity_window = 1.5;
  parts.controller = cascade;
  CHECK(validate(parts)->key == "loop.controller.velocity_window");
  cascade.velocity_window = 2.0;
  parts.controller = cascade;
  CHECK_FALSE(validate(parts));
  NoController none;
  none.sample_time = 0.01;
  parts.controller = none;
  CHECK(validate(parts)->rule.find("nothing to sample") != std::string::npos);
}

TEST_CASE("sampled diagram: the motions are those of the slots and of the cascade") {
  const auto axis = [](std::vector<Block> controllers) {
    LoopParts parts;
    Diagram& diagram = parts.diagram.emplace();
    diagram.output = {1.0, "axis", "y"};
    diagram.load_on = "axis";
    diagram.blocks = {{"axis", "diagram.axis", Plant(Mass{1.0, 0.0, 0.0}), {{{1.0, controllers.back().name, ""}}}},
                      {"friction", "diagram.friction", coulomb(1.5, 1.0), {}, Contact::opposes, "axis"}};
    diagram.blocks.insert(diagram.blocks.end(), controllers.begin(), controllers.end());
    return build_loop(parts);
  };
  const SignalSum error{{1.0, "r", ""}, {-1.0, "axis", "y"}};
  const auto same = [](const Loop& a, const Loop& b) {
    const Settled one = settled(in_time_domain(a, 1).loop, 0.1), other = settled(in_time_domain(b, 1).loop, 0.1);
    REQUIRE(one.outcome == Outcome::irregular);
    REQUIRE(other.outcome == Outcome::irregular);
    CHECK(one.irregular.mean_period == Approx(other.irregular.mean_period).epsilon(1e-9));
    CHECK(one.irregular.half_range == Approx(other.irregular.half_range).epsilon(1e-9));
  };
  LoopParts servo = servo_at(0.02);
  Pid& one = std::get<Pid>(servo.controller);
  one.input_step = 1e-5;
  one.computation_delay = 0.01;
  same(build_loop(servo), axis({{"pid", "diagram.pid", Controller(one), {error}}}));

  Cascade law;
  law.position_kp = 1.0;
  law.velocity_kp = 4.0;
  law.velocity_ki = 6.0;
  law.sample_time = 0.02;
  law.position_every = 3.0;
  LoopParts parts = servo_parts(coulomb(1.5, 1.0));
  parts.controller = law;
  Pid position = pid(1.0, 0.0, 0.0), velocity = pid(4.0, 6.0, 0.0);
  position.sample_time = 0.06;
  velocity.sample_time = 0.02;
  same(build_loop(parts),
       axis({{"position", "diagram.position", Controller(position), {error}},
             {"velocity", "diagram.velocity", Controller(velocity), {{{1.0, "position", ""}, {-1.0, "axis", "v"}}}}}));
}

namespace {

struct QuantizedPi {
  double kp, ki;
  int delay;  ///< samples
  double reference;
};

constexpr double lag_sample = 0.25, reading = 0.01, command = 0.02;

/// 2 exp(-s delay)/(3 s + 1) under a sampled PI that reads in 0.01 and commands in 0.02.
Loop lag_under(const QuantizedPi& law) {
  LoopParts parts;
  FirstOrder plant;
  plant.gain = 2.0;
  plant.time_constant = 3.0;
  plant.delay = law.delay * lag_sample;
  parts.plant = plant;
  Pid controller = pid(law.kp, law.ki, 0.0);
  controller.sample_time = lag_sample;
  controller.input_step = reading;
  controller.output_step = command;
  parts.controller = controller;
  Saturation<double> limit;
  limit.limit = 1.0;
  parts.element = limit;
  parts.reference = law.reference;
  return build_loop(parts);
}

/// Samples after which that loop is exactly where it was, and half its swing at the samples; with the integral counted
/// in thousandths.
std::pair<int, double> recursion(const QuantizedPi& law) {
  constexpr int settling = 8000, more = 4000;
  const double a = std::exp(-lag_sample / 3.0);
  double y = 0.0;
  long integral = 0;
  std::vector<double> waiting(static_cast<std::size_t>(law.delay), 0.0);
  std::vector<std::pair<double, long>> past;
  for (int k = 0; k < settling + more; ++k) {
    const long count = std::lround(std::floor(y / reading + 0.5));
    integral += std::lround(1000.0 * law.reference) - 10 * count;
    const double e = law.reference - static_cast<double>(count) * reading;
    const double u = law.kp * e + law.ki * lag_sample * static_cast<double>(integral) / 1000.0;
    past.emplace_back(y, integral);
    waiting.push_back(std::clamp(command * std::floor(u / command + 0.5), -1.0, 1.0));
    y = a * y + 2.0 * (1.0 - a) * waiting.front();
    waiting.erase(waiting.begin());
  }
  int period = 0;
  for (int j = 1; j < 2000 && period == 0; ++j) {
    const auto& before = past[past.size() - 1 - static_cast<std::size_t>(j)];
    if (before.second == past.back().second && std::abs(before.first - past.back().first) < 1e-12) period = j;
  }
  double low = infinite, high = -infinite;
  for (std::size_t k = settling; k < past.size(); ++k) {
    low = std::min(low, past[k].first);
    high = std::max(high, past[k].first);
  }
  return {period, 0.5 * (high - low)};
}

}  // namespace

TEST_CASE("sampled loops with quanta that repeat themselves after a whole number of samples are cycles of it") {
  for (const QuantizedPi& law : {QuantizedPi{0.8, 0.3, 2, 1.003}, QuantizedPi{1.0, 0.4, 2, 0.507},
                                 QuantizedPi{0.6, 0.2, 2, 1.203}, QuantizedPi{0.8, 0.3, 1, 0.777}}) {
    const auto [period, half_swing] = recursion(law);
    CAPTURE(law.kp, law.delay, period, half_swing);
    REQUIRE(period > 0);
    const Loop loop = in_time_domain(lag_under(law), lowest_pade_order).loop;
    for (const double start : {0.9, 40.0}) {
      CAPTURE(start);
      const Settled found = settled(loop, start);
      CAPTURE(found.why);
      REQUIRE(found.outcome == Outcome::cycle);
      const double samples = found.shot->cycle.period / lag_sample;
      CHECK(samples == Approx(std::round(samples)).epsilon(1e-9));
      CHECK(samples == Approx(period).epsilon(1e-9));
      CHECK(found.shot->cycle.amplitude == Approx(half_swing).epsilon(0.02));  // between samples it swings no farther
      CHECK(found.shot->cycle.stable == true);
    }
  }
}

TEST_CASE("sampled servo without quanta that creeps to its set-point rests, and does not slide") {
  LoopParts parts = servo_parts(coulomb(0.3, 0.3));
  parts.plant = Mass{5.0, 20.0, 0.0};
  Pid controller = pid(2000.0, 8000.0, 150.0);
  controller.tf = 0.005;
  controller.sample_time = 0.01;
  parts.controller = controller;
  const Loop loop = in_time_domain(build_loop(parts), lowest_pade_order).loop;
  for (const double start : {4e-4, 2.078e-5, 1e-5}) {
    CAPTURE(start);
    CHECK(settled(loop, start).outcome == Outcome::rest);
  }
}

TEST_CASE("a servo that reads in steps hunts by them, however little friction it has") {
  for (const double Fc : {1e-9, 1e-6, 0.3}) {
    CAPTURE(Fc);
    LoopParts parts = servo_parts(coulomb(Fc, Fc));
    parts.plant = Mass{5.0, 20.0, 0.0};
    Pid controller = pid(2000.0, 8000.0, 150.0);
    controller.tf = 0.005;
    controller.sample_time = 0.01;
    controller.input_step = 1e-3;
    parts.controller = controller;
    parts.reference = 0.00037;
    const PredictReport report = predict(build_loop(parts), {});
    for (const auto& one : report.outcomes) {
      CHECK((one.outcome == Outcome::irregular || one.outcome == Outcome::cycle));
      if (one.outcome == Outcome::irregular) CHECK(one.irregular.half_range < 1e-3);
    }
  }
}

TEST_CASE("a sampled body that winds up on its bristles for millions of samples is followed without them") {
  LoopParts parts = servo_parts(lugre(1.5, 1.0, 0.4));
  Pid& controller = std::get<Pid>(parts.controller);
  controller.sample_time = 0.001;
  controller.input_step = 1e-6;
  const Loop loop = in_time_domain(build_loop(parts), lowest_pade_order).loop;
  SettleOptions options;
  const Settled found = settle(loop, displaced(loop, 1.36e-5), options);
  CHECK(found.outcome == Outcome::rest);
  CHECK(found.why.find("winds up") != std::string::npos);
  CHECK(found.steps < options.max_readings / 4);
}

TEST_CASE(
    "sampled relay on an integrator: where it swings is decided by the start, and all such cycles are one family") {
  // y moves by 0.1 a sample: what is left of y(0) over that is kept for ever, and the relay turns at each sample.
  Relay<double> relay;
  relay.level = 1.0;
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 0.0}, 0.0};
  Pid controller = pid(1.0, 0.0, 0.0);
  controller.sample_time = 0.1;
  parts.controller = controller;
  parts.element = relay;
  const auto report = predict(build_loop(parts), {});
  REQUIRE(report.cycles.size() == 1);
  CHECK(report.cycles[0].period == Approx(0.2).epsilon(1e-9));
  CHECK(report.cycles[0].amplitude == Approx(0.05).epsilon(1e-9));
  CHECK(report.cycles[0].remembered == 1);
  CHECK(report.cycles[0].stable == true);
  std::set<std::string> why;
  for (const auto& one : report.outcomes) {
    CHECK(one.cycle == 0U);
    why.insert(one.why);
  }
  CHECK(why.contains("converges to cycle 0, or to one of its family of the same size"));
}
