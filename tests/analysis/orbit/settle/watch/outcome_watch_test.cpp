#include "limcycle/analysis/orbit/settle/watch/outcome_watch.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;

namespace {

using Signal = std::function<double(double)>;

/// The cubic through y and its rate at both ends.
OutputStep step_of(const Signal& y, const Signal& rate, double t, double h) {
  const double d0 = h * rate(t), d1 = h * rate(t + h), chord = y(t + h) - y(t);
  return {t, h, y(t), y(t + h), {d0 - chord, 2.0 * chord - d0 - d1, 0.0}};
}

OutcomeWatch watch_of(const Loop& loop) { return {loop, {1e-8, 1e-9, 1e-4}, typical_sizes(loop), slow_time(loop)}; }

/// Feeds y to a watch, in steps of 0.05 s, until it has decided or the time is over; returns the time.
double show(OutcomeWatch& watch, const Signal& y, double duration) {
  const double h = 0.05, eps = 1e-5;
  const Signal rate = [&](double t) { return (y(t + eps) - y(t - eps)) / (2.0 * eps); };
  watch.begin(0.0, y(0.0));
  double t = 0.0;
  for (; t < duration && !watch.decided(); t += h) {
    const OutputStep step = step_of(y, rate, t, h);
    if (step.y0 < watch.level() && step.y1 >= watch.level()) watch.crossed(step);
    if ((rate(t) < 0.0) != (rate(t + h) < 0.0)) watch.turned(step);
  }
  return t;
}

}  // namespace

TEST_CASE("The output over a step turns and crosses levels where the polynomial does") {
  // y = (t - 1)^2 (t + 2) on [0.5, 1.7]: turns at 1; y = 1 at the root of t^3 - 3 t + 1 near 1.532.
  const Signal y = [](double t) { return (t - 1.0) * (t - 1.0) * (t + 2.0); };
  const Signal rate = [](double t) { return 3.0 * (t - 1.0) * (t + 1.0); };
  const OutputStep step = step_of(y, rate, 0.5, 1.2);
  for (const double theta : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    CHECK(step.value(theta) == Approx(y(0.5 + 1.2 * theta)).margin(1e-14));
    CHECK(step.slope(theta) == Approx(1.2 * rate(0.5 + 1.2 * theta)).margin(1e-14));
  }
  CHECK(step.turning().t == Approx(1.0).epsilon(1e-4));
  CHECK(step.turning().y == Approx(0.0).margin(1e-7));
  const OutputStep rising = step_of(y, rate, 1.0, 0.7);
  CHECK(rising.crossing(1.0) == Approx(2.0 * std::cos(2.0 * M_PI / 9.0)).epsilon(1e-12));
}

TEST_CASE("An approach to a cycle is one once the rest of the way is short") {
  const Loop loop = test::servo(test::lugre());
  for (const double pace : {0.1, 0.8, 0.97}) {  // of the approach, per period
    CAPTURE(pace);
    const auto growth = [pace](double t) { return 1.0 - 0.5 * std::pow(pace, t / 3.0); };
    OutcomeWatch watch = watch_of(loop);
    const double until = show(
        watch, [&](double t) { return growth(t) * std::cos(2.0 * M_PI * t / 3.0 + 0.1); }, 3000.0);
    CHECK(watch.outcome() == Outcome::cycle);
    CHECK(watch.period() == Approx(3.0).epsilon(1e-5));
    CHECK(watch.amplitude() == Approx(1.0).epsilon(2e-4));
    CHECK(until > 8.0);
    CHECK(1.0 - growth(until) < 2e-4);  // not before it was close
  }
}

TEST_CASE("A motion that decays or grows at a steady pace, or as 1/t, is no cycle") {
  const Loop loop = test::servo(test::lugre());
  for (const double pace : {0.9, 0.999, 0.9999, 1.001}) {
    CAPTURE(pace);
    OutcomeWatch watch = watch_of(loop);
    show(
        watch, [&](double t) { return std::pow(pace, t / 3.0) * std::cos(2.0 * M_PI * t / 3.0 + 0.1); }, 300.0);
    CHECK(watch.outcome() == Outcome::undecided);
  }
  OutcomeWatch watch = watch_of(loop);
  show(
      watch, [](double t) { return std::cos(2.0 * M_PI * t / 3.0 + 0.1) / (1.0 + t); }, 1000.0);
  CHECK(watch.outcome() == Outcome::undecided);
}

TEST_CASE("Periods of several unequal swings are measured whole") {
  const Loop loop = test::servo(test::lugre());
  OutcomeWatch watch = watch_of(loop);
  show(
      watch, [](double t) { return std::cos(2.0 * M_PI * t / 6.0 + 0.1) + 0.8 * std::cos(4.0 * M_PI * t / 6.0); },
      200.0);
  CHECK(watch.outcome() == Outcome::cycle);
  CHECK(watch.period() == Approx(6.0).epsilon(1e-5));
}
