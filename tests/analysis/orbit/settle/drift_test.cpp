#include "limcycle/analysis/orbit/settle/drift.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

constexpr double turn = 2.0 * std::numbers::pi;  // period of an oscillator with w = 1

Trace period_from(const Loop& loop, const LoopState& state) {
  Trace trace;
  REQUIRE(record(loop, state, turn, 1e-10, 2000, trace) == Status::converged);
  return trace;
}

double amplitude_from(const Loop& loop, const LoopState& state) {
  const auto [low, high] = extremes(period_from(loop, state));
  return 0.5 * (high - low);
}

Drift drift_from(const Loop& loop, const LoopState& state) {
  constexpr double hardly = 1e-4;
  return follow_drift(loop, nearly_closed(loop, state, period_from(loop, state), 2, hardly), {});
}

/// Again and again, up to where it cannot be followed any farther.
Drift end_of_drift(const Loop& loop, const LoopState& state) {
  Drift all;
  for (Drift next = drift_from(loop, state); next.to; next = drift_from(loop, *all.to)) {
    all.to = next.to;
    all.time += next.time;
    all.steps += next.steps;
  }
  return all;
}

/// Amplitude of van der Pol's oscillator for small mu, by averaging; its own error is of the order of mu.
double averaged(double begin, double mu, double t) {
  return 2.0 / std::sqrt(1.0 + (4.0 / (begin * begin) - 1.0) * std::exp(-mu * t));
}

}  // namespace

TEST_CASE("leaps along a slow drift keep to the averaged motion of van der Pol's oscillator") {
  for (const double mu : {1e-3, 1e-4, 1e-5}) {
    for (const double begin : {0.05, 1.0, 3.0}) {
      CAPTURE(mu, begin);
      const Loop loop = van_der_pol(mu);
      const LoopState start = displaced(loop, begin);
      const Drift first = drift_from(loop, start), last = end_of_drift(loop, start);
      REQUIRE(first.to);
      CHECK(amplitude_from(loop, *first.to) == Approx(averaged(begin, mu, first.time)).epsilon(0.005 + mu));
      const double reached = amplitude_from(loop, *last.to);
      CHECK(reached == Approx(averaged(begin, mu, last.time)).epsilon(0.005 + mu));
      CHECK(reached == Approx(2.0).epsilon(1e-3));
      CHECK((reached - 2.0) * (begin - 2.0) > -1e-6);                         // it does not go beyond the cycle
      CHECK(static_cast<double>(last.steps) < 5.0 + 5.0 * last.time / turn);  // a march takes 30 and more a period
    }
  }
}

TEST_CASE("a motion that decays linearly loses the same part in each period") {
  constexpr double mu = -1e-4;
  const Loop loop = van_der_pol(mu);
  const Drift drift = drift_from(loop, displaced(loop, 1e-3));
  REQUIRE(drift.to);
  CHECK(amplitude_from(loop, *drift.to) == Approx(1e-3 * std::exp(0.5 * mu * drift.time)).epsilon(5e-3));
}

TEST_CASE("a motion that repeats itself, or changes fast, is not followed") {
  const Loop centre = van_der_pol(1e-13), fast = van_der_pol(0.5);
  CHECK_FALSE(drift_from(centre, displaced(centre, 1.0)).to);
  CHECK_FALSE(drift_from(fast, displaced(fast, 0.1)).to);
}

TEST_CASE("beside an unstable symmetric cycle the servo drifts for thousands of periods, and comes to rest") {
  // Multiplier 1.0014 to 1.016: each was once called permanent and without a period.
  for (const double kp : {106.0, 118.0}) {
    LoopParts parts = servo_parts(lugre());
    parts.controller = pid(kp, 4.0, 6.0);
    const Loop loop = build_loop(parts);
    for (const double displacement : {0.02, 0.1, 0.7}) {
      CAPTURE(kp, displacement);
      const Settled motion = settle(loop, displaced(loop, displacement), {});
      CHECK(motion.outcome == Outcome::rest);
    }
  }
}
