#include "limcycle/analysis/orbit/derivatives/cycle_derivatives.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/tests/cycle_knobs.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// sum_i w_i p_i d/dp_i of a quantity, for a scaling of all parameters under which its change is known.
double euler(const Derived& found, const LoopParts& parts, const std::vector<Knob>& knobs,
             const std::vector<double>& weights, const std::function<double(const CycleDerivative&)>& what) {
  double sum = 0.0;
  for (std::size_t k = 0; k < knobs.size(); ++k) sum += weights[k] * value(parts, knobs[k]) * what(found.by[k]);
  return sum;
}
double largest_multiplier(const CycleDerivative& one) { return one.multipliers.at(0).value().real(); }

}  // namespace

TEST_CASE("derivatives of a relay loop's cycle are those of its closed forms") {
  // Relay of level M and hysteresis h before b/s: a triangle of amplitude h, period 4 h/(M b), corners at the switches.
  LoopParts parts;
  parts.plant = TransferFunction{{2.0}, {1.0, 0.0}, 0.0};
  parts.element = relay(1.0, 0.1);
  const std::vector<Knob> knobs{
      of_relay("level", &Relay<double>::level),
      of_relay("hysteresis", &Relay<double>::hysteresis),
      {"b", [](LoopParts& p) -> double& { return std::get<TransferFunction>(p.plant).numerator[0]; }}};
  const auto triangle = derived(parts, knobs);
  CHECK(triangle.by[0].period == Approx(-0.2).epsilon(1e-8));
  CHECK(triangle.by[1].period == Approx(2.0).epsilon(1e-8));
  CHECK(triangle.by[2].period == Approx(-0.1).epsilon(1e-8));
  CHECK(triangle.by[1].amplitude == Approx(1.0).epsilon(1e-8));
  for (const std::size_t k : {0U, 2U}) CHECK(std::abs(triangle.by[k].amplitude) <= triangle.by[k].amplitude_error);
  CHECK(triangle.by[0].amplitude_error < 1e-7);

  // Before a lag 1/(tau s + 1): T = 2 tau ln((M + h)/(M - h)), amplitude h.
  const double M = 1.0, h = 0.2, tau = 0.7;
  parts.plant = TransferFunction{{1.0}, {tau, 1.0}, 0.0};
  parts.element = relay(M, h);
  const std::vector<Knob> lag_knobs{knobs[0], knobs[1], {"tau", [](LoopParts& p) -> double& {
                                                           return std::get<TransferFunction>(p.plant).denominator[0];
                                                         }}};
  const auto lag = derived(parts, lag_knobs);
  CHECK(lag.by[0].period == Approx(-4.0 * tau * h / (M * M - h * h)).epsilon(1e-7));
  CHECK(lag.by[1].period == Approx(4.0 * tau * M / (M * M - h * h)).epsilon(1e-7));
  CHECK(lag.by[2].period == Approx(2.0 * std::log((M + h) / (M - h))).epsilon(1e-7));
  CHECK(lag.by[1].amplitude == Approx(1.0).epsilon(1e-7));
}

TEST_CASE("derivatives of stick-slip on a belt are those of claim B4") {
  const auto parts = belt_parts(coulomb(1.5, 1.0));
  const auto knobs = and_levels<Coulomb<double>>(belt_knobs());
  const auto found = derived(parts, knobs, 0.0);
  // T = 2/w (pi - atan(w d/V)) + 2 d/V, amplitude hypot(d, V/w), with w = sqrt(k/m), d = (Fs - Fc)/k: by differences of
  // order 6 of the formula itself.
  const auto formula = [](double m, double k, double V, double Fs, double Fc) {
    const double w = std::sqrt(k / m), d = (Fs - Fc) / k;
    return std::pair(2.0 / w * (std::acos(-1.0) - std::atan(w * d / V)) + 2.0 * d / V, std::hypot(d, V / w));
  };
  const std::vector<double> at{1.0, 2.0, 0.1, 1.5, 1.0};
  REQUIRE(found.cycle.period == Approx(formula(1.0, 2.0, 0.1, 1.5, 1.0).first).epsilon(1e-10));
  for (std::size_t i = 0; i < at.size(); ++i) {
    double period = 0.0, amplitude = 0.0;
    const double step = 2e-3 * at[i];
    for (const auto& [steps, weight] : {std::pair(1, 45.0), {2, -9.0}, {3, 1.0}}) {
      for (const double side : {1.0, -1.0}) {
        auto moved = at;
        moved[i] += side * steps * step;
        const auto [T, a] = formula(moved[0], moved[1], moved[2], moved[3], moved[4]);
        period += side * weight * T / (60.0 * step);
        amplitude += side * weight * a / (60.0 * step);
      }
    }
    CAPTURE(knobs[i].name);
    CHECK(found.by[i].period == Approx(period).epsilon(1e-8));
    CHECK(found.by[i].amplitude == Approx(amplitude).epsilon(1e-8));
    REQUIRE(found.by[i].multipliers.size() == 1);
    CHECK_FALSE(found.by[i].multipliers[0].has_value());  // the exact zero of sticking
  }
}

TEST_CASE("derivatives of the LuGre servo obey its scalings, multipliers included") {
  // No differences of cycles here: identities of Euler. In the order of the knobs mass, kp, ki, kd, Fs, Fc, vs, sigma0,
  // sigma1, sigma2.
  const auto parts = servo_parts(lugre());
  const auto knobs = lugre_knobs();
  const auto found = derived(parts, knobs);
  const double T = found.cycle.period, a = found.cycle.amplitude, m = found.cycle.multipliers[0].real();
  const auto period = [](const CycleDerivative& one) { return one.period; };
  const auto amplitude = [](const CycleDerivative& one) { return one.amplitude; };
  const auto expect = [&](const std::vector<double>& weights, double of_period, double of_amplitude) {
    CHECK(std::abs(euler(found, parts, knobs, weights, period) - of_period * T) < 1e-6 * T);
    CHECK(std::abs(euler(found, parts, knobs, weights, amplitude) - of_amplitude * a) < 1e-6 * a);
    const double of_multiplier = std::abs(euler(found, parts, knobs, weights, largest_multiplier));
    CHECK(of_multiplier < 3e-4 * m);
    double error = 0.0;
    for (std::size_t k = 0; k < knobs.size(); ++k)
      error += std::abs(weights[k] * value(parts, knobs[k])) * found.by[k].multiplier_error;
    CHECK(of_multiplier <= error);
  };
  expect({1, 1, 1, 1, 1, 1, 0, 1, 1, 1}, 0.0, 0.0);           // all forces
  expect({0, 0, 0, 0, 1, 1, 1, 0, 0, 0}, 0.0, 1.0);           // all lengths
  expect({0, -2, -3, -1, -2, -2, -1, -2, -1, -1}, 1.0, 0.0);  // time, at constant mass and lengths
  // Each term alone is far from zero.
  for (std::size_t k = 0; k < knobs.size(); ++k)
    if (k != 7 && k != 8) CHECK(std::abs(value(parts, knobs[k]) * largest_multiplier(found.by[k])) > 0.1 * m);
  // Parameters that act at the same place have equal effects.
  CHECK(found.by[3].period == Approx(found.by[9].period).epsilon(1e-8));
  CHECK(largest_multiplier(found.by[3]) == Approx(largest_multiplier(found.by[9])).epsilon(1e-6));
}

TEST_CASE("derivatives of van der Pol: what only scales y leaves period and multiplier, and errors fall as stated") {
  // x'' - mu x' + x + c (x^3)' = 0: y is proportional to 1/sqrt(c).
  LoopParts parts;
  parts.plant = TransferFunction{{1.0, 0.0}, {1.0, -1.3, 1.0}, 0.0};
  Cubic<double> cubic;
  cubic.coefficient = 0.4;
  parts.element = cubic;
  const std::vector<Knob> knobs{
      {"c", [](LoopParts& p) -> double& { return law_of<Cubic<double>>(*p.element).coefficient; }},
      {"-mu", [](LoopParts& p) -> double& { return std::get<TransferFunction>(p.plant).denominator[1]; }}};
  const auto found = derived(parts, knobs);
  CHECK(found.by[0].amplitude == Approx(-0.5 * found.cycle.amplitude / 0.4).epsilon(1e-7));
  CHECK(std::abs(found.by[0].period) <= found.by[0].period_error);
  CHECK(found.by[0].period_error < 1e-6);
  CHECK(std::abs(*found.by[0].multipliers[0]) <= found.by[0].multiplier_error);
  check_differences(parts, {knobs[1]}, {found.cycle, {found.by[1]}}, 1e-6);
  const auto expected = differences(parts, knobs[1], found.cycle);
  CHECK(found.by[1].multipliers[0]->real() == Approx(expected.multiplier).epsilon(1e-5));

  const auto best = derived(parts, knobs, 1.0, 1e-12);
  double last = infinite;
  for (const double rtol : {1e-6, 1e-8, 1e-10}) {
    const auto rough = derived(parts, knobs, 1.0, rtol);
    const double error = std::abs(rough.by[1].period - best.by[1].period);
    CAPTURE(rtol, error, rough.by[1].period_error);
    CHECK(error <= rough.by[1].period_error);
    CHECK(error < 0.3 * last);
    const double of_multiplier = std::abs(*rough.by[1].multipliers[0] - *best.by[1].multipliers[0]);
    CHECK(of_multiplier <= rough.by[1].multiplier_error);
    last = error;
  }
  CHECK(last < 1e-6 * std::abs(best.by[1].period));
}

TEST_CASE("derivatives where the coordinates of the linear part have a corner are less accurate, and say so") {
  // The time scale of the realisation is max(1, |a|) at a = -1. An independent Runge-Kutta run gives dT/da.
  LoopParts parts;
  parts.plant = TransferFunction{{1.0, 0.0}, {1.0, -1.0, 1.0}, 0.0};
  Cubic<double> cubic;
  cubic.coefficient = 1.0 / 3.0;
  parts.element = cubic;
  const auto found = derived(
      parts, {{"a", [](LoopParts& p) -> double& { return std::get<TransferFunction>(p.plant).denominator[1]; }}});
  const double error = std::abs(found.by[0].period + 0.731596597766);
  CHECK(error < 1e-4);
  CHECK(error <= found.by[0].period_error);
  CHECK(found.by[0].period_error < 1e-3);
}

TEST_CASE("derivatives of a cycle: what cannot be derived is told") {
  const auto parts = servo_parts(lugre());
  const Loop loop = build_loop(parts);
  const Cycle cycle = the_cycle(loop, 1.0);
  auto pairs = neighbours(parts, {servo_knobs()[0]});
  CHECK(cycle_derivatives(loop, cycle, {}).by.empty());

  Cycle open = cycle;
  open.period *= 1.1;
  const auto none = cycle_derivatives(loop, open, pairs);
  CHECK(none.status == Status::stalled);
  CHECK(none.by.empty());
  CHECK_FALSE(none.why.empty());

  CycleDerivativeOptions options;
  options.max_steps = 10;
  CHECK(cycle_derivatives(loop, cycle, pairs, options).status == Status::max_iterations);
  options = {};
  options.stop = [] { return true; };
  CHECK(cycle_derivatives(loop, cycle, pairs, options).status == Status::interrupted);

  options = {};
  options.multipliers = false;
  const auto few = cycle_derivatives(loop, cycle, pairs, options);
  CHECK(few.status == Status::converged);
  CHECK(few.by.at(0).multipliers.empty());

  pairs[0].step = 0.0;
  CHECK_THROWS_AS(cycle_derivatives(loop, cycle, pairs), std::invalid_argument);
  pairs[0].step = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(cycle_derivatives(loop, cycle, pairs), std::invalid_argument);
  pairs[0] = {build_loop(servo_parts(coulomb(1.5, 1.0))), loop, 1e-5, 1.0};
  CHECK_THROWS_AS(cycle_derivatives(loop, cycle, pairs), std::invalid_argument);
}

TEST_CASE("derivatives over half a period of a symmetric cycle are those over the whole") {
  const auto parts = servo_parts(lugre());
  const Loop loop = build_loop(parts);
  const Cycle cycle = the_cycle(loop, 1.0);
  REQUIRE(cycle.half_wave_symmetric);
  const auto knobs = lugre_knobs();
  auto pairs = neighbours(parts, knobs);
  // The set-point moves the middle, and with the integral action nothing else.
  const auto lifted = [&](double to) {
    LoopParts moved = parts;
    moved.reference = to;
    return build_loop(moved);
  };
  pairs.push_back({lifted(-1e-6), lifted(1e-6), 1e-6, 0.0});
  const auto half = cycle_derivatives(loop, cycle, pairs);
  REQUIRE(half.status == Status::converged);
  CHECK(half.by.back().offset == Approx(1.0).epsilon(1e-8));
  CHECK(std::abs(half.by.back().amplitude) <= half.by.back().amplitude_error);
  CHECK(std::abs(half.by.back().period) <= half.by.back().period_error);

  // A level for one direction breaks the symmetry, so the whole period is integrated.
  const auto one_sided = [](double Fc) {
    auto law = lugre();
    law.Fc_minus = Fc;
    return servo(law);
  };
  pairs.push_back({one_sided(1.0 - 1e-6), one_sided(1.0 + 1e-6), 1e-6, 1.0});
  const auto whole = cycle_derivatives(loop, cycle, pairs);
  REQUIRE(whole.status == Status::converged);
  for (std::size_t k = 0; k < half.by.size(); ++k) {
    CAPTURE(k);
    const auto &a = half.by[k], &b = whole.by[k];
    CHECK(std::abs(a.period - b.period) <= a.period_error + b.period_error);
    CHECK(std::abs(a.amplitude - b.amplitude) <= a.amplitude_error + b.amplitude_error);
    CHECK(std::abs(a.first_harmonic - b.first_harmonic) <= a.first_harmonic_error + b.first_harmonic_error);
    CHECK(std::abs(a.offset - b.offset) <= a.offset_error + b.offset_error);
    REQUIRE(a.multipliers.at(0).has_value());
    CHECK(std::abs(*a.multipliers[0] - *b.multipliers[0]) <= a.multiplier_error + b.multiplier_error);
  }
  // The derivative by both levels together is that by Fc, over half periods.
  CHECK(whole.by.back().period == Approx(0.5 * whole.by[5].period).epsilon(1e-5));
  CHECK(whole.by.back().amplitude == Approx(0.5 * whole.by[5].amplitude).epsilon(1e-5));
}
