#include "limcycle/analysis/orbit/shooting.hpp"

#include <catch2/catch.hpp>

#include "limcycle/analysis/orbit/measure.hpp"
#include "limcycle/analysis/orbit/settle.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

Cycle cycle_of(const Loop& loop, double displacement = 1.0) {
  SettleOptions options;
  options.amplitude_floor = 1e-7;
  const auto settled = settle(loop, displaced(loop, displacement), options);
  INFO(settled.why);
  REQUIRE(settled.outcome == Outcome::cycle);
  return settled.shot->cycle;
}

}  // namespace

TEST_CASE("hunting servo with LuGre friction: period to 1e-10, amplitude, stability") {
  const Loop loop = servo(lugre());
  const Cycle cycle = cycle_of(loop);
  CHECK(cycle.period == Approx(24.436786455993).epsilon(1e-10));
  CHECK(cycle.amplitude == Approx(0.063903).epsilon(1e-5));
  CHECK(std::abs(cycle.offset) < 1e-9);
  CHECK(cycle.half_wave_symmetric);
  REQUIRE(cycle.stable);
  CHECK(*cycle.stable);
  REQUIRE(cycle.multipliers.size() == 3);
  CHECK(std::abs(cycle.multipliers[0]) == Approx(0.0061457).epsilon(1e-3));  // 0.0784^2
  CHECK(std::abs(cycle.multipliers[2]) < 1e-8);
  CHECK(std::abs(cycle.period / 24.436786455993 - 1.0) <= cycle.error);
  CHECK(cycle.error < 1e-8);

  // Substitute back: after one period the state is where it began.
  Trace trace;
  REQUIRE(record(loop, cycle.start, cycle.period, 1e-11, 100, trace) == Status::converged);
  CHECK(trace.y.back() == Approx(trace.y.front()).margin(1e-9));
}

TEST_CASE("PID with Coulomb friction and stiction: the exact cycles of claim B7") {
  struct Row {
    double Fs, sigma2, amplitude, period, stick, multiplier;
  };
  for (const Row& row : {Row{1.5, 0.0, 0.06724015, 23.36927229, 9.11619722, 0.0886262},
                         Row{1.5, 0.4, 0.06565304, 24.01303872, 9.35339812, 0.0975085},
                         Row{1.1, 0.4, 0.01313061, 84.93938497, 39.81657125, 0.0975085}}) {
    const Cycle cycle = cycle_of(servo(coulomb(row.Fs, 1.0, row.sigma2)));
    CHECK(cycle.amplitude == Approx(row.amplitude).epsilon(2e-7));
    CHECK(cycle.period == Approx(row.period).epsilon(1e-9));
    CHECK(cycle.sticking_fraction == Approx(2.0 * row.stick / row.period).epsilon(1e-6));
    REQUIRE(cycle.multipliers.size() == 2);
    CHECK(cycle.multipliers[0].real() == Approx(row.multiplier * row.multiplier).epsilon(1e-5));
    CHECK(std::abs(cycle.multipliers[1]) < 1e-9);  // the exact zero of sticking
  }
}

TEST_CASE("relay loops: period and peak of claim B1") {
  struct Row {
    Loop loop;
    double half_period, peak, radius;
  };
  for (const Row& row : {Row{forward(relay(1.0), {1.0}, {1.0, 3.0, 3.0, 1.0}), 1.83987534, 0.16306148, 0.383990575},
                         Row{forward(relay(1.0), {1.0}, {1.0, 2.0, 1.0, 0.0}), 3.21223060, 0.65831341, 0.353748014},
                         Row{forward(relay(1.0, 0.1), {1.0}, {1.0, 1.0, 0.0}), 1.42362311, 0.23445282, 0.240839845}}) {
    const Cycle cycle = cycle_of(row.loop);
    CHECK(cycle.period == Approx(2.0 * row.half_period).epsilon(1e-8));
    CHECK(cycle.amplitude == Approx(row.peak).epsilon(1e-7));
    CHECK(cycle.multipliers[0].real() == Approx(row.radius * row.radius).epsilon(1e-5));
    CHECK(cycle.sticking_fraction == 0.0);
  }
  const Cycle triangle = cycle_of(forward(relay(1.0, 0.1), {1.0}, {1.0, 0.0}));
  CHECK(triangle.period == Approx(0.4).epsilon(1e-11));
  CHECK(triangle.amplitude == Approx(0.1).epsilon(1e-11));
  CHECK(triangle.first_harmonic == Approx(0.8 / (std::acos(-1.0) * std::acos(-1.0))).epsilon(1e-9));
  const Cycle lag = cycle_of(forward(relay(1.0, 0.2), {1.0}, {1.0, 1.0}));
  CHECK(lag.period == Approx(2.0 * std::log(1.2 / 0.8)).epsilon(1e-10));
}

TEST_CASE("stick-slip on a belt: claim B4, ideal stiction and LuGre") {
  const Cycle dry = cycle_of(belt(coulomb(1.5, 1.0)), 0.0);
  const double w0 = std::sqrt(2.0), delta = 0.25, speed = 0.1;
  const double slip = 2.0 / w0 * (std::acos(-1.0) - std::atan(w0 * delta / speed)), stick = 2.0 * delta / speed;
  CHECK(dry.period == Approx(slip + stick).epsilon(1e-10));
  CHECK(dry.amplitude == Approx(std::hypot(delta, speed / w0)).epsilon(1e-9));
  CHECK(dry.sticking_fraction == Approx(stick / (slip + stick)).epsilon(1e-9));
  CHECK_FALSE(dry.half_wave_symmetric);
  CHECK(cycle_of(belt(coulomb(1.5, 1.0, 0.4)), 0.0).period == Approx(6.453933).epsilon(1e-7));
  CHECK(cycle_of(belt(lugre()), 0.0).period == Approx(6.36272).epsilon(1e-6));
  CHECK(cycle_of(belt(lugre(1.5, 1.0, 0.0)), 0.0).period == Approx(7.49381).epsilon(1e-6));
}

TEST_CASE("van der Pol (mu = 1) as a forward loop with a cubic: claim B3") {
  // x'' - x' + x + (x^3/3)' = 0: plant s/(s^2 - s + 1), element x^3/3.
  Cubic<double> cubic;
  cubic.coefficient = 1.0 / 3.0;
  const Cycle cycle = cycle_of(forward(cubic, {1.0, 0.0}, {1.0, -1.0, 1.0}));
  CHECK(cycle.period == Approx(6.66328686).epsilon(1e-8));
  CHECK(cycle.amplitude == Approx(2.00861986).epsilon(1e-8));
  CHECK(cycle.multipliers[0].real() == Approx(8.596951e-4).epsilon(1e-3));
}

TEST_CASE("an unstable cycle is found by Newton from a guess, and is called unstable") {
  // Relay with dead zone before 1/(s+1)^3: the small root of the describing function is an unstable cycle.
  const Loop loop = forward(relay(1.0, 0.0, 0.05), {1.0}, {1.0, 3.0, 3.0, 1.0});
  SettleOptions options;
  options.amplitude_floor = 1e-6;
  CHECK(settle(loop, displaced(loop, 1.0), options).outcome == Outcome::cycle);
  CHECK(settle(loop, displaced(loop, 0.01), options).outcome == Outcome::rest);
}

TEST_CASE("period error falls as the integration tolerance does") {
  const Loop loop = servo(lugre());
  const auto period = [&](double rtol) {
    SettleOptions options;
    options.shooting.rtol = rtol;
    options.shooting.tolerance = 30.0 * rtol;
    const auto settled = settle(loop, displaced(loop, 1.0), options);
    REQUIRE(settled.shot);
    CHECK(std::abs(settled.shot->cycle.period / 24.436786455993 - 1.0) <= settled.shot->cycle.error);
    return std::abs(settled.shot->cycle.period / 24.436786455993 - 1.0);
  };
  CHECK(period(1e-8) < 1e-7);
  CHECK(period(1e-10) < 1e-9);
}
