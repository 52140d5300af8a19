#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/settle/growth.hpp"
#include "limcycle/analysis/orbit/settle/irregular.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/orbit/settle/watch/standstill.hpp"
#include "limcycle/analysis/orbit/simulate/ensemble.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/tests/gantry.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

Settled settled(const Loop& loop, const LoopState& start, double floor = 1e-9) {
  SettleOptions options;
  options.amplitude_floor = floor;
  options.shooting.rtol = options.shooting.derivative_rtol = 1e-9;
  options.shooting.tolerance = 1e-9;
  return settle(loop, start, options);
}

/// The outcome, which an ensemble must find as well.
Settled from(const Loop& loop, double displacement, double floor = 1e-9) {
  const LoopState start = displaced(loop, displacement);
  const Settled found = settled(loop, start, floor);
  const EnsembleMember member{&loop, start};
  EnsembleOptions options;
  options.amplitude_floor = floor;
  options.rtol = 1e-7;
  const auto run = run_ensemble({&member, 1}, options);
  CHECK(to_string(run.members.front().outcome) == to_string(found.outcome));
  return found;
}

/// Residual of A X + B w + E ext at a state, with the outputs of the elements in its modes.
double residual(const Loop& loop, const Standstill& at, const std::vector<Mode>& modes) {
  LoopField field(loop);
  field.modes() = modes;
  State dx;
  field.rate(at.x, dx, 0.0);
  double most = 0.0;
  for (const double rate : dx) most = std::max(most, std::abs(rate));
  return most;
}

/// tests/reproducers/steady-sliding.toml.
Loop fast_belt() {
  auto law = with_levels<LuGre<double>>(2.23263, 0.929416);
  law.vs = 0.214598;
  law.sigma0 = 4369.04;
  law.sigma2 = 0.292573;
  LoopParts parts;
  parts.plant = Belt{0.00304597, 11.3083, 0.0, 0.961147};
  parts.friction = law;
  return build_loop(parts);
}

/// tests/reproducers/persistent-motion.toml.
Loop ringing_belt() {
  auto law = with_levels<LuGre<double>>(0.947309, 0.829387);
  law.vs = 0.726938;
  law.sigma0 = 1.22012;
  law.sigma1 = 0.0492811;
  law.sigma2 = 0.000437707;
  LoopParts parts;
  parts.plant = Belt{0.00106628, 0.0288527, 7.93458e-05, 2.63828};
  parts.friction = law;
  return build_loop(parts);
}

/// tests/reproducers/ideal-relay-two-lags.toml.
Loop two_lags(double reference) {
  LoopParts parts;
  const double a = 0.516256, b = 0.641899;
  parts.plant = TransferFunction{{1.53267}, {1.0, a + b, a * b}, 0.0};
  parts.element = relay(0.0568247);
  parts.reference = reference;
  return build_loop(parts);
}

}  // namespace

TEST_CASE("a stuck body whose integrator winds up does not slide, whatever rounding moves it by") {
  // tests/reproducers/sliding-while-stuck.toml
  auto parts = servo_parts(coulomb(54.2729, 31.8252, 2.83006));
  parts.plant = Mass{0.995585, 0.0, 0.0};
  parts.controller = pid(3167.67, 124599.0, 124.463);
  const Loop loop = build_loop(parts);
  for (const double start : {0.05547, 5.547e-5, 5.547e-7}) {
    const auto found = from(loop, start, 1e-8);
    CHECK(found.outcome == Outcome::cycle);
    REQUIRE(found.shot);
    CHECK(found.shot->cycle.period == Approx(0.520293599).epsilon(1e-8));
  }
}

TEST_CASE("a constant reference moves the rest and makes nothing slide") {
  // tests/reproducers/sliding-constant-reference.toml
  auto parts = servo_parts(coulomb(0.950836, 0.950836));
  parts.plant = Mass{0.00768172, 0.0, 0.0};
  auto controller = pid(16.3538, 351.526, 0.912668);
  controller.tf = 0.000304757;
  parts.controller = controller;
  for (const double reference : {0.0, 0.02151238978096834, -0.37}) {
    parts.reference = reference;
    const Loop loop = build_loop(parts);
    for (const double start : {0.1676, 0.0001676}) {
      CAPTURE(reference, start);
      CHECK(from(loop, start, 1e-7).outcome == Outcome::rest);
    }
  }
}

TEST_CASE("a steady slide is found by substitution, and is where the motion ends") {
  const Loop loop = fast_belt();
  const auto found = from(loop, 0.3);
  CHECK(found.outcome == Outcome::sliding);
  CHECK(found.steps < 3000);
  // k y = F(speed): one line of algebra.
  LoopField field(loop);
  const LoopState start = displaced(loop, 0.1);
  field.modes() = start.modes;
  State near = start.x;
  near[0] = 0.1;
  near[1] = 0.0;
  near[2] = -0.0002;
  const auto at = standstill_near(field, near, loop_sizes(loop));
  REQUIRE(at);
  CHECK(at->slides);
  CHECK(residual(loop, *at, start.modes) < 1e-9);
  const double g = 0.929416 + (2.23263 - 0.929416) * std::exp(-std::pow(0.961147 / 0.214598, 2));
  CHECK(at->x[0] == Approx((g + 0.292573 * 0.961147) / 11.3083).epsilon(1e-9));
}

TEST_CASE("a body under a load with viscous friction only slides for ever") {
  LoopParts parts;
  parts.plant = Mass{1.0, 0.0, 0.0};
  parts.controller = pid(0.0, 0.0, 2.0);
  parts.friction = coulomb(1.0, 1.0);
  parts.load = 3.0;  // v = (3 - 1)/2
  CHECK(from(build_loop(parts), 0.1).outcome == Outcome::sliding);
  parts.load = 0.9;
  CHECK(from(build_loop(parts), 0.1).outcome == Outcome::rest);
}

TEST_CASE("an ideal relay behind two lags rests through ever faster switching") {
  for (const double reference : {0.0, 0.0114723, -0.05}) {
    CAPTURE(reference);
    const Loop loop = two_lags(reference);
    for (const double start : {0.7, 0.001}) {
      const auto found = from(loop, start);
      CHECK(found.outcome == Outcome::rest);
      CHECK(found.by == "switching");
      CHECK(found.why.find("0.386") != std::string::npos);  // (0.516 + 0.642)/3: q/3 of the transfer function
    }
  }
  // Beyond the range that the relay can hold (level over gain at rest: 0.2628) it rests away from the surface.
  const auto beyond = from(two_lags(0.3), 0.01);
  CHECK(beyond.outcome == Outcome::rest);
  CHECK(beyond.by.empty());
}

TEST_CASE("the swings before that rest decay as the algebra says") {
  const Loop loop = two_lags(0.0114723);
  const LoopState start = displaced(loop, 0.05);
  LoopField field(loop);
  field.modes() = start.modes;
  March march(field, StepperKind::automatic, loop_weights(loop, 1e-7));
  march.begin(start.x, 0.0);
  std::vector<std::pair<double, double>> speeds;  // time and |dy/dt| at switches in one direction
  while (speeds.size() < 700 && march.step(100.0) == Status::converged) {
    if (!march.last().switched) continue;
    if (const double v = field.y_rate(march.last().dx0); v > 0.0) speeds.emplace_back(march.t(), 0.0);
    if (!speeds.empty() && speeds.back().second == 0.0) {
      State dx;
      field.rate(march.x(), dx, 0.0);
      speeds.back().second = std::abs(field.y_rate(dx));
    }
  }
  const auto [t0, v0] = speeds[speeds.size() / 2];
  const auto [t1, v1] = speeds.back();
  CHECK(std::log(v0 / v1) / (t1 - t0) == Approx((0.516256 + 0.641899) / 3.0).epsilon(0.02));
}

TEST_CASE("three states: the sliding mode of order two decides, and a relay that pulls the wrong way never rests") {
  // Relative degree two with a zero at -2: rest; with q = C A^2 B/(C A B) = 4 - 1.5 > 0 (zero at -4, poles 1.5 in sum):
  // no rest.
  CHECK(from(forward(relay(1.0), {1.0, 2.0}, {1.0, 6.0, 11.0, 6.0}), 0.3).by == "switching");
  CHECK(from(forward(relay(1.0), {1.0, 4.0}, {1.0, 1.5, 0.74, 0.12}), 0.3).outcome == Outcome::cycle);
}

TEST_CASE("a centre is a family of periodic motions") {
  for (const double start : {297.0, 1.0, 0.01}) {
    CHECK(from(forward(relay(1.0), {1.0}, {1.0, 0.0, 0.0}), start).outcome == Outcome::family);
    CHECK(from(forward(saturation(0.1), {1.0}, {1.0, 0.0, 1.0}), start).outcome == Outcome::family);
    CHECK(from(forward(saturation(1.0), {1.0}, {1.0, 0.0, 0.0}), start).outcome == Outcome::family);
  }
  DeadZone<double> gap;
  gap.half_width = 0.5;
  for (const double start : {2.97e4, 297.0}) {
    CHECK(from(forward(gap, {1.0}, {1.0, 0.0, 0.0}), start).outcome == Outcome::family);
    CHECK(from(forward(relay(1.0, 0.0, 0.1), {3.0}, {2.0, 0.0, 0.0}), start).outcome == Outcome::family);
  }
}

TEST_CASE("a body that slides on a belt with constant friction on an undamped spring swings by what it began with") {
  // It swings about y = Fc/k = 0.5 as long as it stays slower than the belt, at 0.1 m/s; faster motions end at
  // amplitude v/w = 0.1/sqrt(2), which touches the speed of the belt.
  const Loop loop = belt(coulomb(1.0, 1.0));
  for (const double start : {0.7, 1e-3, 1e-6}) {
    const auto found = from(loop, start);
    CAPTURE(start);
    CHECK(found.outcome == Outcome::family);
  }
}

TEST_CASE("beat of a motion against the samples of its loop: the distance of its period from whole samples") {
  // A period of 10.3 samples, the phase of which wobbles with the beat.
  constexpr double sample = 0.1, period = 10.3 * sample, beat = 2.0 * M_PI * 0.3 / period;
  const auto motion = [](double wobble) {
    Trace trace;
    for (int i = 0; i < 40000; ++i) {
      const double t = 0.01 * i, phase = 2.0 * M_PI * t / period + wobble * std::sin(beat * t);
      trace.t.push_back(t);
      trace.y.push_back(std::sin(phase));
      trace.rate.push_back(std::cos(phase) * (2.0 * M_PI / period + wobble * beat * std::cos(beat * t)));
    }
    const auto found = permanent_motion(trace, true);
    REQUIRE(found);
    return *found;
  };
  const IrregularMotion regular = motion(0.1);
  const double error = 2.0 * M_PI * (regular.longest_period - regular.shortest_period) / (sample * regular.observed);
  CHECK(std::abs(beat_frequency(regular, sample) - beat) <= error);
  CHECK(error < 0.05 * beat);
  CHECK(beat_frequency(motion(0.9), sample) == 0.0);     // single periods differ by more than a sample
  CHECK(beat_frequency(regular, period / 10.0) == 0.0);  // whole samples on the mean: no beat was seen
}

TEST_CASE("a body that creeps to rest at the edge of stiction rests, however long it waited before") {
  // Viscous friction is stronger than the fall of the curve at low speed (delta = 2), and the slowest pole of the
  // sliding motion is real (-0.22 1/s, beside -0.54 +- 0.63j): with a start of y0, the integrator winds up for Fs/(ki
  // y0), and then the body creeps to y = 0.
  auto law = stribeck(2.43802, 1.2087, 0.000126115);
  law.sigma2 = 6.54143;
  law.delta = 2.0;
  LoopParts parts;
  parts.plant = Mass{741.747, 0.0, 0.0};
  parts.controller = pid(686.146, 113.127, 955.585);
  parts.friction = law;
  LoopParts otherwise = parts;
  otherwise.plant = ZeroPoleGain{{}, {0.0, 0.0}, 1.0 / 741.747};
  for (const LoopParts& writing : {parts, otherwise}) {
    const Loop loop = build_loop(writing);
    for (const double y0 : {1.141e-05, 1.141e-07, 1.141e-09}) {
      CAPTURE(y0);
      const auto found = from(loop, y0);
      CHECK(found.outcome == Outcome::rest);
      CHECK(found.steps < 1000);
      CHECK(found.time > 2.43802 / (113.127 * y0));
    }
  }
}

TEST_CASE("a slow decay is rest, with its rate") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 2e-5, 1.0}, 0.0};
  parts.controller = pid(0.0, 0.0, 0.0);
  parts.element = saturation(1.0);
  const auto found = settled(build_loop(parts), displaced(build_loop(parts), 0.5), 1e-3);
  CHECK(found.outcome == Outcome::rest);
  CHECK(found.why.find("1e-05") != std::string::npos);
}

TEST_CASE("a motion that never repeats itself has a range and a mean period, not a cycle") {
  const Loop loop = ringing_belt();
  for (const double start : {46.0, 0.005}) {
    const auto found = from(loop, start, 1e-4);
    CHECK(found.outcome == Outcome::irregular);
    CHECK(found.irregular.half_range == Approx(0.88514).epsilon(1e-3));
    CHECK(found.irregular.mean_period == Approx(1.352).epsilon(0.01));
  }
}

TEST_CASE("what decays, grows, or repeats itself after several swings is not irregular") {
  const auto trace_of = [](auto y) {
    Trace trace;
    for (int i = 0; i < 60000; ++i) {
      const double t = 0.02 * i, eps = 1e-5;
      trace.t.push_back(t);
      trace.y.push_back(y(t));
      trace.rate.push_back((y(t + eps) - y(t - eps)) / (2.0 * eps));
    }
    return trace;
  };
  CHECK_FALSE(permanent_motion(trace_of([](double t) { return std::exp(-1e-4 * t) * std::sin(3.0 * t); })));
  CHECK_FALSE(permanent_motion(trace_of([](double t) { return std::exp(1e-4 * t) * std::sin(3.0 * t); })));
  CHECK_FALSE(permanent_motion(trace_of([](double t) { return std::sin(3.0 * t) + 0.4 * std::cos(0.6 * t); })));
  const auto torus =
      permanent_motion(trace_of([](double t) { return std::sin(3.0 * t) + 0.4 * std::cos(M_SQRT2 * t); }));
  REQUIRE(torus);
  CHECK(torus->half_range == Approx(1.4).epsilon(1e-3));
  // Its settling is no part of it, though it took more than a third of the record.
  const auto settled = permanent_motion(trace_of([](double t) {
    return (1.0 + 0.6 * std::exp(-1e-3 * std::max(0.0, t - 300.0) * (t - 300.0))) *
           (std::sin(3.0 * t) + 0.4 * std::cos(M_SQRT2 * t)) * (t < 300.0 ? 0.7 : 1.0);
  }));
  REQUIRE(settled);
  CHECK(settled->half_range == Approx(1.4).epsilon(5e-3));
}

TEST_CASE("a body that creeps to rest at the edge of stiction rests, though rounding makes it stick and break away") {
  // The level of stiction is that of sliding, or a PID damps the slide more than the falling curve drives it: the body
  // never sticks before its velocity is rounding.
  struct Creep {
    double mass, kp, ki, kd, Fs, Fc, vs, sigma2;
  };
  for (const auto& [mass, kp, ki, kd, Fs, Fc, vs, sigma2] :
       {Creep{0.0795399, 102.569, 412.819, 4.02363, 116.545, 116.545, 0.305837, 0.0285199},
        Creep{0.185648, 21.7171, 38.065, 3.66186, 0.0629749, 0.0573527, 0.00220016, 0.0}}) {
    auto law = stribeck(Fs, Fc, vs);
    law.delta = 1.0;
    law.sigma2 = sigma2;
    auto parts = servo_parts(law);
    parts.plant = Mass{mass, 0.0, 0.0};
    parts.controller = pid(kp, ki, kd);
    const Loop loop = build_loop(parts);
    for (const double start : {100.0 * Fs / kp, Fs / kp, 0.1 * Fs / kp}) {
      CAPTURE(Fs, start);
      const auto found = from(loop, start, 1e-9 * Fs / kp);
      CHECK(found.outcome == Outcome::rest);
      CHECK(found.steps < 5000);
    }
  }
}

TEST_CASE("a belt whose body breaks away at once is marched at any tolerance") {
  auto law = stribeck(0.34817, 0.139534, 0.0472815);
  law.delta = 1.0;
  LoopParts parts;
  parts.plant = Belt{1.13312e-05, 3.44875, 0.000151654, 0.524752};
  parts.friction = law;
  const Loop loop = build_loop(parts);
  for (const double start : {1.0, 0.01, 1e-5}) {
    const auto found = from(loop, start);
    REQUIRE(found.shot);
    CHECK(found.shot->cycle.period == Approx(0.231978514).epsilon(1e-6));  // the checker of tests/random_loops
    CHECK(found.shot->cycle.amplitude == Approx(0.0593637).epsilon(1e-4));
  }
  for (const auto kind : {StepperKind::dopri5, StepperKind::rodas5p})
    for (const double rtol : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
      CAPTURE(to_string(kind), rtol);
      LoopField field(loop);
      field.modes() = {Mode{0}};
      March march(field, kind, loop_weights(loop, rtol));
      march.begin({0.01, 0.524752}, 0.0);
      Status status = Status::converged;
      while (status == Status::converged && march.t() < 1.0 && march.steps() < 20000) status = march.step(1.0);
      CHECK(status == Status::converged);
      CHECK(march.t() >= 1.0);
    }
}

TEST_CASE("a set-point a million million motions away, or a load, changes the place of a cycle and nothing else") {
  const auto home = from(gantry(0.7), 1.9e-5, 1e-10);
  REQUIRE(home.shot);
  for (const auto& [reference, load] : {std::pair(0.3, 0.0), std::pair(-10.0, 30.0), std::pair(1e6, -1e5)}) {
    const auto away = from(gantry(0.7, reference, load), 1.9e-5, 1e-10);
    REQUIRE(away.shot);
    CHECK(away.outcome == Outcome::cycle);
    CHECK(away.shot->cycle.period == Approx(home.shot->cycle.period).epsilon(1e-12));
    CHECK(away.shot->cycle.amplitude == Approx(home.shot->cycle.amplitude).epsilon(1e-12));
    CHECK(away.shot->cycle.offset == Approx(reference).epsilon(1e-15));
    CHECK(away.shot->cycle.trace.y_origin == Approx(reference).epsilon(1e-15));
  }
}

TEST_CASE("Stribeck curves with infinite slope at rest are marched") {
  // delta = 0.70: 3.33533 s and 4.0158 um, by an explicit integration in another language that begins each slide at
  // v = 1e-22 m/s, too.
  const auto sharp = from(gantry(0.7), 1.9e-5, 1e-10);
  REQUIRE(sharp.shot);
  CHECK(sharp.shot->cycle.period == Approx(3.33533).epsilon(3e-5));
  CHECK(sharp.shot->cycle.amplitude == Approx(4.0158e-6).epsilon(3e-4));
  double last = 0.0;
  for (const double delta : {0.6, 0.8, 0.9}) {
    CAPTURE(delta);
    const auto found = from(gantry(delta), 1.9e-5, 1e-10);
    REQUIRE(found.shot);
    CHECK(found.shot->cycle.stable == true);
    CHECK(found.shot->cycle.period != last);
    last = found.shot->cycle.period;
  }
}

TEST_CASE("rest: a body that a limited command cannot break away stays where it is while the integrator winds up") {
  LoopParts parts = servo_parts(stribeck(1.5, 1.0, 0.01));
  Pid controller = pid(3.0, 4.0, 6.0);
  controller.saturation = 1.4;
  parts.controller = controller;
  for (const double displacement : {1.0, -20.0}) {
    const Settled found = from(build_loop(parts), displacement);
    CHECK(found.outcome == Outcome::rest);
    CHECK(found.time < 1e6);
  }
  controller.saturation = 1.6;  // a little more, and it breaks away again and again
  parts.controller = controller;
  CHECK(from(build_loop(parts), 1.0).outcome == Outcome::cycle);
}

TEST_CASE("divergence: growth is tried from afar, where a damped spring that bounds it shows") {
  // A conditionally stable loop: large motions, against the limit of the command, wind up.
  const auto grows = [](double stiffness, double displacement) {
    LoopParts parts = servo_parts(coulomb(4.0, 4.0));
    parts.plant = Mass{.mass = 1.0, .damping = stiffness, .stiffness = stiffness};
    Pid controller = pid(60.0, 100.0, 3.0);
    controller.saturation = 60.0;
    parts.controller = controller;
    const Loop loop = build_loop(parts);
    return grows_from_afar(loop, displaced(loop, displacement), 2.0 * displacement, 1e-9, 20'000, {});
  };
  CHECK(grows(0.0, 100.0));
  CHECK_FALSE(grows(1.0, 100.0));
  CHECK_FALSE(grows(0.0, 1e-6));  // thirty times as far is still within the limit of the command and stuck
}

TEST_CASE("divergence: growth at a speed that viscous friction limits, in swings far slower than the poles") {
  auto law = stribeck(372.201, 372.201, 11.7406);
  law.delta = 1.0;
  law.sigma2 = 0.0335198;
  LoopParts parts = servo_parts(law);
  parts.plant = Mass{0.00244064, 0.0, 0.0};
  Pid controller = pid(661.923, 26289.9, 2.07175);
  controller.saturation = 5229.07;
  parts.controller = controller;
  const Loop loop = build_loop(parts);
  SettleOptions options;
  options.amplitude_ceiling = 1e12;
  const Settled settled = settle(loop, displaced(loop, 3011.0), options);
  CHECK(settled.outcome == Outcome::divergence);
  CHECK(settled.steps < options.max_steps);
  CHECK(settle(loop, displaced(loop, 301.1), options).outcome == Outcome::rest);
}

TEST_CASE("divergence: swings that grow like a power of time have no bound") {
  TurningPoints power, line, fades, grows;
  for (int n = 0; n < 400; ++n) {
    const double sign = n % 2 == 0 ? 1.0 : -1.0;
    const auto feed = [&](TurningPoints& turning, double size) { turning.feed(n, sign * size); };
    feed(power, 1.0 + std::pow(n, 0.6));
    feed(line, 5.0 + 0.1 * n);
    feed(fades, 5.0 - 4.0 * std::exp(-0.01 * n));
    feed(grows, std::exp(0.01 * n));
  }
  CHECK(grows_like_a_power(power));
  CHECK(grows_like_a_power(line));
  CHECK_FALSE(grows_like_a_power(fades));  // comes to 5
  CHECK_FALSE(grows_like_a_power(grows));  // leaves an unstable rest, for a cycle perhaps
}

TEST_CASE("divergence: slow growth out of a rest that is hardly unstable ends in the cycle around it") {
  // Three lags with a gain of 8.01, limited at 1: stable beyond, and unstable by 4e-4 1/s within.
  const Loop lags = forward(saturation(1.0), {8.01}, {1.0, 3.0, 3.0, 1.0});
  for (const double start : {0.02298, 0.0002298}) {
    const Settled near = settled(lags, displaced(lags, start));
    CHECK((near.outcome == Outcome::cycle || near.outcome == Outcome::undecided));
    CHECK((!near.shot || near.shot->cycle.amplitude == Approx(1.0104).epsilon(1e-3)));
  }
  // Van der Pol with mu = 0.002: every motion comes to the swing of 2.
  const Loop circle = van_der_pol(0.002);
  for (const double start : {0.02, 0.000516})
    CHECK(settled(circle, displaced(circle, start)).outcome != Outcome::divergence);
}
