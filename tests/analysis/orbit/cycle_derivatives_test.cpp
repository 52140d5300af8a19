#include "limcycle/analysis/orbit/cycle_derivatives.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "limcycle/analysis/orbit/settle.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// A number of the parts of a loop.
struct Knob {
  const char* name;
  std::function<double&(LoopParts&)> of;
};

template <class Law>
Knob of_law(const char* name, double Law::*member) {
  return {name, [member](LoopParts& parts) -> double& { return std::get<Law>(*parts.friction).*member; }};
}
template <class Type>
Knob of_plant(const char* name, double Type::*member) {
  return {name, [member](LoopParts& parts) -> double& { return std::get<Type>(parts.plant).*member; }};
}
Knob of_pid(const char* name, double Pid::*member) {
  return {name, [member](LoopParts& parts) -> double& { return std::get<Pid>(parts.controller).*member; }};
}
Knob of_relay(const char* name, double Relay<double>::*member) {
  return {name, [member](LoopParts& parts) -> double& { return std::get<Relay<double>>(*parts.element).*member; }};
}

double value(const LoopParts& parts, const Knob& knob) {
  LoopParts copy = parts;
  return knob.of(copy);
}

/// The loop with another value; friction stays the same in both directions.
Loop with(const LoopParts& parts, const Knob& knob, double to) {
  LoopParts changed = parts;
  knob.of(changed) = to;
  if (changed.friction)
    std::visit(
        [](auto& law) {
          if constexpr (requires { law.Fs_minus; }) {
            law.Fs_minus = law.Fs;
            law.Fc_minus = law.Fc;
          }
        },
        *changed.friction);
  return build_loop(changed);
}

std::vector<ParameterNeighbours> neighbours(const LoopParts& parts, const std::vector<Knob>& knobs) {
  std::vector<ParameterNeighbours> found;
  for (const Knob& knob : knobs) {
    const double at = value(parts, knob), low = at * (1.0 - 1e-6), high = at * (1.0 + 1e-6);
    found.push_back({with(parts, knob, low), with(parts, knob, high), 0.5 * (high - low), at});
  }
  return found;
}

Cycle the_cycle(const Loop& loop, double displacement) {
  SettleOptions options;
  options.amplitude_floor = 1e-7;
  const auto settled = settle(loop, displaced(loop, displacement), options);
  INFO(settled.why);
  REQUIRE(settled.outcome == Outcome::cycle);
  return settled.shot->cycle;
}

struct Derived {
  Cycle cycle;
  std::vector<CycleDerivative> by;
};
Derived derived(const LoopParts& parts, const std::vector<Knob>& knobs, double displacement = 1.0,
                double rtol = 1e-10) {
  const Loop loop = build_loop(parts);
  Derived result{the_cycle(loop, displacement), {}};
  CycleDerivativeOptions options;
  options.rtol = rtol;
  const auto found = cycle_derivatives(loop, result.cycle, neighbours(parts, knobs), options);
  INFO(found.why);
  REQUIRE(found.status == Status::converged);
  REQUIRE(found.by.size() == knobs.size());
  result.by = found.by;
  for (const auto& one : result.by) CHECK(one.multipliers.size() == result.cycle.multipliers.size());
  return result;
}

/// Derivatives by differences of whole solutions, of order 4: period, amplitude, and the largest multiplier.
struct Differences {
  double period, amplitude, multiplier;
};
Differences differences(const LoopParts& parts, const Knob& knob, const Cycle& cycle, double relative = 3e-4) {
  const double at = value(parts, knob), h = relative * at;
  const Section section = choose_section(build_loop(parts), cycle.trace);
  ShootingOptions options;
  options.rtol = 3e-13;
  options.tolerance = 1e-11;
  options.derivative_rtol = 1e-11;
  options.warm_maps = 1;
  Differences sum{0.0, 0.0, 0.0};
  for (const auto& [steps, weight] : {std::pair(1.0, 8.0), {-1.0, -8.0}, {2.0, -1.0}, {-2.0, 1.0}}) {
    const auto shot =
        shoot(with(parts, knob, at + steps * h), cycle.start, section, cycle.half_wave_symmetric, options);
    REQUIRE(shot.status == Status::converged);
    const double share = weight / (12.0 * h);
    sum.period += share * shot.cycle.period;
    sum.amplitude += share * shot.cycle.amplitude;
    if (!shot.cycle.multipliers.empty()) sum.multiplier += share * shot.cycle.multipliers[0].real();
  }
  return sum;
}

void check(double found, double error, double expected, double relative, double floor) {
  CAPTURE(found, error, expected);
  CHECK(std::abs(found - expected) <= relative * std::abs(expected) + floor);
  CHECK(std::abs(found - expected) <= error + floor);
}

/// Period and amplitude against differences: to 1e-5, and to the error that is stated. The floor is what differences of
/// numbers that are right to 1e-11 leave.
void check_differences(const LoopParts& parts, const std::vector<Knob>& knobs, const Derived& found,
                       double accuracy = 1e-5) {
  for (std::size_t k = 0; k < knobs.size(); ++k) {
    CAPTURE(knobs[k].name);
    const auto expected = differences(parts, knobs[k], found.cycle);
    const double floor = 3e-8 / std::abs(value(parts, knobs[k]));
    check(found.by[k].period, found.by[k].period_error, expected.period, accuracy, floor * found.cycle.period);
    check(found.by[k].amplitude, found.by[k].amplitude_error, expected.amplitude, accuracy,
          floor * found.cycle.amplitude);
  }
}

std::vector<Knob> servo_knobs() {
  return {of_plant("mass", &Mass::mass), of_pid("kp", &Pid::kp), of_pid("ki", &Pid::ki), of_pid("kd", &Pid::kd)};
}
template <class Law>
std::vector<Knob> and_levels(std::vector<Knob> knobs) {
  knobs.push_back({"Fs", [](LoopParts& parts) -> double& { return std::get<Law>(*parts.friction).Fs; }});
  knobs.push_back({"Fc", [](LoopParts& parts) -> double& { return std::get<Law>(*parts.friction).Fc; }});
  return knobs;
}
std::vector<Knob> lugre_knobs() {
  using Law = LuGre<double>;
  auto knobs = and_levels<Law>(servo_knobs());
  knobs.push_back({"vs", [](LoopParts& parts) -> double& { return std::get<Law>(*parts.friction).vs; }});
  knobs.push_back(of_law("sigma0", &Law::sigma0));
  knobs.push_back(of_law("sigma1", &Law::sigma1));
  knobs.push_back(of_law("sigma2", &Law::sigma2));
  return knobs;
}
LoopParts belt_parts(Element<double> friction) {
  LoopParts parts;
  parts.plant = Belt{1.0, 2.0, 0.0, 0.1};
  parts.friction = std::move(friction);
  return parts;
}
std::vector<Knob> belt_knobs() {
  return {of_plant("mass", &Belt::mass), of_plant("stiffness", &Belt::stiffness), of_plant("speed", &Belt::speed)};
}

/// sum_i w_i p_i d/dp_i of something, for a scaling of all parameters under which it is known how it changes.
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

TEST_CASE("derivatives of the hunting LuGre servo by all its numbers, against differences of its cycle") {
  const auto parts = servo_parts(lugre());
  const auto knobs = lugre_knobs();
  const auto found = derived(parts, knobs);
  check_differences(parts, knobs, found);
  for (const auto& one : found.by) {
    CHECK(one.period_error < 1e-5 * std::abs(one.period));
    REQUIRE(one.multipliers.size() == 3);
    REQUIRE(one.multipliers[0].has_value());
    CHECK_FALSE(one.multipliers[1].has_value());  // below rounding
    CHECK(std::abs(one.multipliers[0]->imag()) < 1e-9 * std::abs(*one.multipliers[0]));
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
  expect({0, -2, -3, -1, -2, -2, -1, -2, -1, -1}, 1.0, 0.0);  // time, the mass and lengths being kept
  // Each alone is far from nothing.
  for (std::size_t k = 0; k < knobs.size(); ++k)
    if (k != 7 && k != 8) CHECK(std::abs(value(parts, knobs[k]) * largest_multiplier(found.by[k])) > 0.1 * m);
  // What acts at one place acts alike.
  CHECK(found.by[3].period == Approx(found.by[9].period).epsilon(1e-8));
  CHECK(largest_multiplier(found.by[3]) == Approx(largest_multiplier(found.by[9])).epsilon(1e-6));
}

TEST_CASE("derivatives through break-away and exact sticking: the Coulomb servo, period, amplitude and multiplier") {
  const auto parts = servo_parts(coulomb(1.5, 1.0, 0.4));
  auto knobs = and_levels<Coulomb<double>>(servo_knobs());
  knobs.push_back(of_law("sigma2", &Coulomb<double>::sigma2));
  const auto found = derived(parts, knobs);
  check_differences(parts, knobs, found, 1e-7);
  for (std::size_t k = 0; k < knobs.size(); ++k) {
    CAPTURE(knobs[k].name);
    const double expected = differences(parts, knobs[k], found.cycle).multiplier;
    CHECK(std::abs(found.by[k].multipliers[0].value() - expected) < 3e-6 * std::abs(expected) + 1e-9);
    CHECK_FALSE(found.by[k].multipliers[1].has_value());
  }
}

TEST_CASE("derivatives with other laws: Stribeck, Karnopp, elasto-plastic, GMS, and a belt that moves the kink") {
  auto karnopp = with_levels<Karnopp<double>>(1.5, 1.0);
  karnopp.vs = 1e-2;
  karnopp.dv = 1e-3;
  karnopp.sigma2 = 0.4;
  auto elastic = with_levels<ElastoPlastic<double>>(1.5, 1.0);
  elastic.vs = 1e-3;
  elastic.sigma0 = 1e5;
  elastic.sigma1 = 300.0;
  elastic.sigma2 = 0.4;
  auto gms = with_levels<Gms<double>>(1.5, 1.0);
  gms.vs = 1e-2;
  gms.k = {1e4, 5e3};
  gms.alpha = {0.5, 0.5};
  gms.C = 50.0;
  gms.sigma1 = {10.0, 10.0};
  gms.sigma2 = 0.4;
  const auto check_servo = [](const LoopParts& parts, const std::vector<Knob>& knobs, double displacement) {
    const auto found = derived(parts, knobs, displacement);
    check_differences(parts, knobs, found);
  };
  check_servo(servo_parts(stribeck(1.5, 1.0, 0.01)), and_levels<Stribeck<double>>(servo_knobs()), 1.0);
  check_servo(servo_parts(karnopp), and_levels<Karnopp<double>>(servo_knobs()), 1.0);
  check_servo(servo_parts(elastic), and_levels<ElastoPlastic<double>>({servo_knobs()[0], servo_knobs()[1]}), 1.0);
  check_servo(servo_parts(gms), and_levels<Gms<double>>({servo_knobs()[1]}), 1.0);
  check_servo(belt_parts(lugre()), and_levels<LuGre<double>>({belt_knobs()[0], belt_knobs()[1]}), 0.0);
  const auto parts = belt_parts(lugre());
  const std::vector<Knob> speed{belt_knobs()[2]};
  const auto found = derived(parts, speed, 0.0);
  check_differences(parts, speed, found, 5e-5);  // the amplitude all but ignores the speed
  CHECK(found.by[0].period_error < 5e-6 * std::abs(found.by[0].period));
}

TEST_CASE("derivatives of van der Pol: what only scales y leaves period and multiplier, and errors fall as stated") {
  // x'' - mu x' + x + c (x^3)' = 0: y is as 1/sqrt(c).
  LoopParts parts;
  parts.plant = TransferFunction{{1.0, 0.0}, {1.0, -1.3, 1.0}, 0.0};
  Cubic<double> cubic;
  cubic.coefficient = 0.4;
  parts.element = cubic;
  const std::vector<Knob> knobs{
      {"c", [](LoopParts& p) -> double& { return std::get<Cubic<double>>(*p.element).coefficient; }},
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
