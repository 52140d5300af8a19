#include "limcycle/analysis/orbit/cycle/multiple_shooting.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"
#include "limcycle/analysis/study/balance/orbit_guess.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

const std::vector<double> three_lags{1.0, 3.0, 3.0, 1.0};

/// A sinusoidal guess of the given amplitude of the element's input and frequency.
OrbitGuess sinusoid(const Loop& loop, double amplitude, double frequency) {
  const FirstHarmonicBalance balance(loop);
  return guess_orbit(
      loop, [&](double phase) { return balance.linear_state(amplitude, frequency, phase); }, frequency,
      symmetry(loop).has_value());
}

/// One period later the motion is back at its start.
void check_closes(const Loop& loop, const Cycle& cycle, double accuracy) {
  Trace trace;
  REQUIRE(record(loop, cycle.start, cycle.period, 1e-12, 100, trace) == Status::converged);
  CHECK(std::abs(trace.y.back() - trace.y.front()) < accuracy * cycle.amplitude);
  CHECK(std::abs(trace.rate.back() - trace.rate.front()) < accuracy * cycle.amplitude * cycle.frequency());
}

}  // namespace

TEST_CASE("multiple shooting: stable cycles from guesses that are far off") {
  const Loop relay_loop = forward(relay(1.0), {1.0}, three_lags);
  for (const double amplitude : {0.1, 0.159, 0.25})
    for (const double frequency : {1.5, 1.73, 2.1}) {
      CAPTURE(amplitude, frequency);
      const auto found = shoot_multiple(relay_loop, sinusoid(relay_loop, amplitude, frequency));
      REQUIRE(found.status == Status::converged);
      CHECK(found.cycle.period == Approx(2.0 * 1.83987534).epsilon(3e-9));
      CHECK(found.cycle.stable == true);
      CHECK(found.cycle.half_wave_symmetric);
    }
  const Loop oscillator = van_der_pol(1.0);
  for (const double amplitude : {1.6, 2.0, 3.0}) {
    const auto found = shoot_multiple(oscillator, sinusoid(oscillator, amplitude, 0.95));
    REQUIRE(found.status == Status::converged);
    CHECK(found.cycle.period == Approx(6.66328686).epsilon(1e-9));
    CHECK(found.cycle.multipliers[0].real() == Approx(8.596951e-4).epsilon(1e-6));
  }
}

TEST_CASE("multiple shooting: unstable cycles, to which no motion leads") {
  // Backwards in time the cycle of van der Pol is the same and its multiplier the inverse.
  struct Row {
    double mu, period, amplitude, multiplier;
  };
  for (const Row& row : {Row{0.1, 6.28711127, 2.00010398, 0.5330693}, Row{0.5, 6.38067580, 2.00248793, 3.917692e-2},
                         Row{1.0, 6.66328686, 2.00861986, 8.596951e-4}}) {
    const Loop loop = van_der_pol(-row.mu);
    CAPTURE(row.mu);
    const auto found = shoot_multiple(loop, sinusoid(loop, 1.9, 1.02));
    INFO(found.why);
    REQUIRE(found.status == Status::converged);
    CHECK(found.cycle.period == Approx(row.period).epsilon(1e-9));
    CHECK(found.cycle.amplitude == Approx(row.amplitude).epsilon(3e-9));
    CHECK(found.cycle.stable == false);
    CHECK(found.cycle.multipliers[0].real() == Approx(1.0 / row.multiplier).epsilon(1e-6));
    check_closes(loop, found.cycle, 1e-6);
  }
}

TEST_CASE("multiple shooting: the unstable cycles of dead zones, from the roots of their describing functions") {
  DeadZone<double> zone;
  zone.half_width = 0.1;
  const Loop smooth = forward(zone, {10.0}, three_lags);
  const auto found = shoot_multiple(smooth, sinusoid(smooth, 0.634, std::sqrt(3.0)));
  REQUIRE(found.status == Status::converged);
  CHECK(found.cycle.stable == false);
  CHECK(found.cycle.frequency() == Approx(std::sqrt(3.0)).epsilon(5e-3));
  CHECK(found.cycle.first_harmonic == Approx(0.634).epsilon(2e-2));
  check_closes(smooth, found.cycle, 1e-8);

  // Relay: N = (4/(pi A)) sqrt(1 - (d/A)^2) = 8 has a small root (unstable) and a large one.
  const double d = 0.05, q = 8.0 * std::numbers::pi / 4.0;
  for (const bool large : {false, true}) {
    const double square = (1.0 + (large ? 1.0 : -1.0) * std::sqrt(1.0 - 4.0 * q * q * d * d)) / (2.0 * q * q);
    const Loop loop = forward(relay(1.0, 0.0, d), {1.0}, three_lags);
    const auto cycle = shoot_multiple(loop, sinusoid(loop, std::sqrt(square), std::sqrt(3.0)));
    INFO(cycle.why);
    REQUIRE(cycle.status == Status::converged);
    CHECK(cycle.cycle.stable == large);
    CHECK(cycle.cycle.first_harmonic == Approx(std::sqrt(square)).epsilon(0.1));
    check_closes(loop, cycle.cycle, 1e-9);
  }
}

TEST_CASE("multiple shooting: where there is no cycle it says so") {
  const Loop calm = forward(saturation(1.0), {6.0}, three_lags);  // stable rest, no root of the describing function
  for (const double amplitude : {0.5, 1.5, 3.0}) {
    const auto none = shoot_multiple(calm, sinusoid(calm, amplitude, std::sqrt(3.0)));
    CHECK(none.status != Status::converged);
    CHECK_FALSE(none.why.empty());
  }
  // All nodes at rest: the equations hold, but it is no cycle.
  OrbitGuess rest{{8, LoopState{State(3, 0.0), {Mode{0}}}}, 3.6, false};
  const auto resting = shoot_multiple(calm, rest);
  CHECK(resting.status == Status::no_cycle);
  CHECK(resting.why == "multiple shooting ended at a point of rest");

  const Loop loop = forward(relay(1.0), {1.0}, three_lags);
  ShootingOptions options;
  options.stop = [] { return true; };
  CHECK(shoot_multiple(loop, sinusoid(loop, 0.159, 1.73), options).status == Status::interrupted);
}
