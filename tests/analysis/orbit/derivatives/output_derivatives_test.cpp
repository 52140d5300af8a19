#include "limcycle/analysis/orbit/derivatives/output_derivatives.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/motion/steppers/transition.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/tests/cycle_knobs.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// First harmonic and offset against differences of cycles, of order 4.
void check_outputs(const LoopParts& parts, const std::vector<Knob>& knobs, const Derived& found, double accuracy) {
  const Section section = choose_section(build_loop(parts), found.cycle.trace);
  ShootingOptions options;
  options.rtol = 3e-13;
  options.tolerance = 1e-11;
  options.derivative_rtol = 1e-11;
  options.warm_maps = 1;
  for (std::size_t k = 0; k < knobs.size(); ++k) {
    const double at = value(parts, knobs[k]), h = 1e-3 * at;
    double harmonic = 0.0, offset = 0.0;
    for (const auto& [steps, weight] : {std::pair(1.0, 8.0), {-1.0, -8.0}, {2.0, -1.0}, {-2.0, 1.0}}) {
      const auto shot = shoot(with(parts, knobs[k], at + steps * h), found.cycle.start, section,
                              found.cycle.half_wave_symmetric, options);
      REQUIRE(shot.status == Status::converged);
      harmonic += weight / (12.0 * h) * shot.cycle.first_harmonic;
      offset += weight / (12.0 * h) * shot.cycle.offset;
    }
    CAPTURE(knobs[k].name);
    const double floor = 3e-8 * found.cycle.amplitude / at;
    check(found.by[k].first_harmonic, found.by[k].first_harmonic_error, harmonic, accuracy, floor);
    check(found.by[k].offset, found.by[k].offset_error, offset, accuracy, floor);
    CHECK(found.by[k].first_harmonic_error < 10.0 * accuracy * std::abs(harmonic) + floor);
  }
}

LoopParts biased_relay() {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 3.0, 3.0, 1.0}, 0.0};
  parts.element = relay(1.0, 0.02, 0.05);
  parts.reference = 0.05;
  return parts;
}
std::vector<Knob> biased_relay_knobs() {
  return {of_relay("level", &Relay<double>::level),
          of_relay("hysteresis", &Relay<double>::hysteresis),
          of_relay("dead_zone", &Relay<double>::dead_zone),
          {"reference", [](LoopParts& p) -> double& { return p.reference; }},
          {"lag", [](LoopParts& p) -> double& { return std::get<TransferFunction>(p.plant).denominator[1]; }}};
}

}  // namespace

TEST_CASE("derivatives of harmonic and offset: a triangle, and the mean force of a belt") {
  // Relay before b/s: a triangle of amplitude h, first harmonic 8 h/pi^2.
  LoopParts parts;
  parts.plant = TransferFunction{{2.0}, {1.0, 0.0}, 0.0};
  parts.element = relay(1.0, 0.1);
  const auto triangle =
      derived(parts, {of_relay("level", &Relay<double>::level), of_relay("hysteresis", &Relay<double>::hysteresis)});
  CHECK(triangle.by[1].first_harmonic == Approx(8.0 / (std::numbers::pi * std::numbers::pi)).epsilon(1e-8));
  CHECK(std::abs(triangle.by[0].first_harmonic) <= triangle.by[0].first_harmonic_error);
  CHECK(std::abs(triangle.by[1].offset) <= triangle.by[1].offset_error);
  CHECK(triangle.by[1].offset_error < 1e-6);

  // Stick-slip on a belt: y swings about Fc/k, on which no other parameter acts.
  const auto belt = derived(belt_parts(coulomb(1.5, 1.0)), and_levels<Coulomb<double>>(belt_knobs()), 0.0);
  const std::vector<double> expected{0.0, -0.25, 0.0, 0.0, 0.5};
  for (std::size_t k = 0; k < expected.size(); ++k) {
    CAPTURE(k);
    CHECK(belt.by[k].offset == Approx(expected[k]).margin(2e-8));
    CHECK(std::abs(belt.by[k].offset - expected[k]) <= belt.by[k].offset_error);
  }
}

TEST_CASE("derivatives of harmonic and offset against differences: exact flow") {
  const auto relay_parts = biased_relay();
  check_outputs(relay_parts, biased_relay_knobs(), derived(relay_parts, biased_relay_knobs(), 0.3), 1e-6);
  const auto belt = belt_parts(coulomb(1.5, 1.0));
  const auto knobs = and_levels<Coulomb<double>>(belt_knobs());
  check_outputs(belt, knobs, derived(belt, knobs, 0.0), 1e-6);
  const auto servo = servo_parts(coulomb(1.5, 1.0, 0.4));
  const auto of_servo = and_levels<Coulomb<double>>(servo_knobs());
  check_outputs(servo, of_servo, derived(servo, of_servo), 3e-6);
}

TEST_CASE("derivatives of harmonic and offset against differences: bristles") {
  const auto servo = servo_parts(lugre());
  check_outputs(servo, lugre_knobs(), derived(servo, lugre_knobs()), 1e-5);
  const auto belt = belt_parts(lugre(1.5, 1.0, 0.1));
  const auto knobs = and_levels<LuGre<double>>(belt_knobs());
  check_outputs(belt, knobs, derived(belt, knobs, 0.0), 1e-5);
}

TEST_CASE("derivatives of harmonic and offset: errors fall with the tolerance and are stated") {
  const auto belt = belt_parts(lugre(1.5, 1.0, 0.1));
  const std::vector<Knob> knobs{belt_knobs()[1]};
  const auto best = derived(belt, knobs, 0.0, 1e-12);
  double last = infinite;
  for (const double rtol : {1e-8, 1e-9, 1e-10}) {
    const auto rough = derived(belt, knobs, 0.0, rtol);
    const double harmonic = std::abs(rough.by[0].first_harmonic - best.by[0].first_harmonic);
    const double offset = std::abs(rough.by[0].offset - best.by[0].offset);
    CAPTURE(rtol, harmonic, offset, rough.by[0].first_harmonic_error, rough.by[0].offset_error);
    CHECK(harmonic <= rough.by[0].first_harmonic_error);
    CHECK(offset <= rough.by[0].offset_error);
    CHECK(harmonic < 0.5 * last);
    last = harmonic;
  }
  CHECK(last < 3e-6 * std::abs(best.by[0].first_harmonic));
}

TEST_CASE("readings at the stages of a step are a quadrature of order 5") {
  double sum = 0.0;
  for (int power = 0; power <= 4; ++power) {
    sum = 0.0;
    for (Eigen::Index i = 0; i < StageReadings::count; ++i)
      sum += StageReadings::weight(i) * std::pow(StageReadings::node(i), power);
    CHECK(sum == Approx(1.0 / (power + 1)).epsilon(1e-14));
  }
  // Deviations of a linear loop: the reading at the last stage is that of the end.
  const Loop loop = forward(saturation(100.0), {1.0}, {1.0, 0.6, 2.0});
  LoopField field(loop);
  State x(field.size(), 0.1), dx;
  field.start(x, 0.0);
  field.rate(x, dx, 0.0);
  Step step;
  step.t1 = 0.3;
  step.x0 = step.x1 = x;
  step.dx0 = step.dx1 = dx;
  StageReadings readings;
  readings.row = Eigen::RowVectorXd::LinSpaced(std::ssize(x), 1.0, 2.0);
  const Eigen::MatrixXd whole = transition(field, step, 0, {}, &readings);
  REQUIRE(readings.at.rows() == 3);
  CHECK((readings.at.row(2) - readings.row * whole).norm() < 1e-14);
  CHECK((readings.at.row(0) - readings.row).norm() > 1e-3);
}
