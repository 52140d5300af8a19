#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/models/element/memoryless/sine.hpp"
#include "limcycle/tests/analysis/frequency/df_laws.hpp"
#include "limcycle/tests/loops.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

Sine<double> sine_of(double amplitude, double period = 2.0 * std::numbers::pi) {
  Sine<double> element;
  element.amplitude = amplitude;
  element.period = period;
  return element;
}

Block in_diagram(const std::string& name, BlockKind what, std::vector<SignalSum> inputs) {
  return {name, "diagram." + name, std::move(what), std::move(inputs)};
}

/// Phase-locked loop: phase detector sin(error), low-pass, oscillator, of which the reference runs ahead by `offset`.
Loop phase_locked(double gain, double filter, double offset, double period) {
  const double unit = period / (2.0 * std::numbers::pi);  // of the phases
  LoopParts parts;
  Diagram& diagram = parts.diagram.emplace();
  diagram.blocks = {in_diagram("detector", Element(sine_of(1.0, period)), {{{1.0, "r", ""}, {-1.0, "phase", ""}}}),
                    in_diagram("filter", LinearBlock(LowPass{.time_constant = filter, .gain = gain * unit}),
                               {{{1.0, "detector", ""}}}),
                    in_diagram("ahead", LinearBlock(Constant{-offset * unit}), {}),
                    in_diagram("phase", LinearBlock(Integrator{}), {{{1.0, "filter", ""}, {1.0, "ahead", ""}}})};
  diagram.output = {1.0, "phase", ""};
  return build_loop(parts);
}

/// One axis with a sine of its position that pulls, or the pendulum that has it as its weight.
Loop swinging(bool as_pendulum, const Element& law) {
  const double mass = 1.3, arm = 0.4, gravity = 9.81, inertia = 0.5, damping = 0.02, radius = 0.05, speed = 4.0;
  LoopParts parts;
  if (as_pendulum) {
    FroudePendulum plant;
    plant.mass = mass;
    plant.arm = arm;
    plant.gravity = gravity;
    plant.inertia = inertia;
    plant.damping = damping;
    plant.shaft_radius = radius;
    plant.shaft_speed = speed;
    parts.plant = plant;
    parts.controller = NoController{};
    parts.friction = law;
    return build_loop(parts);
  }
  // In the coordinate q = radius y of the rubbing surface, of the mass inertia/radius^2.
  Belt belt;
  belt.mass = inertia / (radius * radius);
  belt.damping = damping / (radius * radius);
  belt.stiffness = 5.0;  // which its input takes off again
  belt.speed = radius * speed;
  Diagram& diagram = parts.diagram.emplace();
  diagram.blocks = {
      in_diagram("body", Plant(belt), {{{-1.0, "weight", ""}, {5.0, "body", "y"}}}),
      in_diagram("weight", Element(sine_of(mass * gravity * arm / radius, 2.0 * std::numbers::pi * radius)),
                 {{{1.0, "body", "y"}}}),
      {"rubbing", "diagram.rubbing", law, {}, Contact::opposes, "body"}};
  diagram.output = {1.0, "body", "y"};
  diagram.load_on = "body";
  return build_loop(parts);
}

}  // namespace

TEST_CASE("sine: describing function and mean against its samples, about any bias and in any unit") {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (int k = 0; k < samples(30); ++k) {
    const double amplitude = 4.0 * part(random) - 2.0, period = std::pow(10.0, 6.0 * part(random) - 3.0),
                 A = period * 2.0 * part(random), b = period * (part(random) - 0.5);
    INFO("amplitude " << amplitude << ", period " << period << ", A " << A << ", bias " << b);
    const auto element = sine_of(amplitude, period);
    double sine = 0.0, mean = 0.0;
    constexpr int n = 4096;  // a smooth periodic integrand: exact but for rounding
    for (int i = 0; i < n; ++i) {
      const double s = std::sin(2.0 * std::numbers::pi * i / n), y = element.output({b + A * s, 0.0, 0.0}, {}, {});
      sine += 2.0 * y * s / n;
      mean += y / n;
    }
    const auto gain = element.exact_describing_function(A, 3.0, b);
    REQUIRE(gain);
    CHECK(gain->real() * A == Approx(sine).margin(1e-12 * std::abs(amplitude)));
    CHECK(gain->imag() == 0.0);
    CHECK(element.mean_output(b, A) == Approx(mean).margin(1e-12 * std::abs(amplitude)));
    const double h = 1e-6 * period, slope = (element.mean_output(b + h, A) - element.mean_output(b - h, A)) / (2.0 * h);
    CHECK(element.mean_slope(b, A) * period == Approx(slope * period).margin(1e-8 * std::abs(amplitude)));
    const DescribingFunction numeric = describing_function(element, {A, 3.0, b}, with(DfMethod::fft, 1e-10));
    CHECK(std::abs(numeric.gain - *gain) * A < 1e-9 * std::abs(amplitude));
  }
}

TEST_CASE("phase-locked loop: it rests where the sine of its error is what the offset needs, in any unit of phase") {
  for (const double period : {2.0 * std::numbers::pi, 1.0, 360.0}) {
    const double unit = period / (2.0 * std::numbers::pi);
    const Loop loop = phase_locked(2.0, 0.3, 1.1, period);
    bool exact = false;
    const Eigen::VectorXd rest = loop.rest_point(exact);
    CHECK(exact);
    CHECK(std::abs(loop.output_origin + loop.C_y * rest) == Approx(unit * std::asin(0.55)).epsilon(1e-12));
    const PredictReport report = predict(loop, {});
    CHECK(report.cycles.empty());
    for (const auto& one : report.outcomes) CHECK(one.outcome == Outcome::rest);
  }
}

TEST_CASE("a weight as a sine in a diagram is the pendulum: the same cycle by every method") {
  auto law = stribeck(17.0, 7.4, 0.1);
  const PredictReport one = predict(swinging(true, law), {}), other = predict(swinging(false, law), {});
  REQUIRE_FALSE(one.cycles.empty());
  constexpr double radius = 0.05, turn = 2.0 * std::numbers::pi * radius;
  const auto same = [&](const Cycle& of_pendulum, const Cycle& drawn) {
    const double turns = (drawn.offset - radius * of_pendulum.offset) / turn;  // a start may lead over some
    return std::abs(drawn.period / of_pendulum.period - 1.0) < 1e-7 &&
           std::abs(drawn.amplitude / (radius * of_pendulum.amplitude) - 1.0) < 1e-6 &&
           std::abs(turns - std::round(turns)) < 1e-6 && drawn.stable == of_pendulum.stable;
  };
  for (const Cycle& cycle : one.cycles)
    CHECK(std::ranges::any_of(other.cycles, [&](const Cycle& drawn) { return same(cycle, drawn); }));
  for (const Cycle& drawn : other.cycles)
    CHECK(std::ranges::any_of(one.cycles, [&](const Cycle& cycle) { return same(cycle, drawn); }));
}
