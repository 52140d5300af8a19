#include "limcycle/analysis/energy/loop/circle.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "limcycle/analysis/frequency/describing_function/error_band.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/models/element/memoryless/cubic.hpp"
#include "limcycle/models/element/memoryless/dead_zone.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

const std::vector<double> three_lags{1.0, 3.0, 3.0, 1.0}, integrator_and_two_lags{1.0, 2.0, 1.0, 0.0};

Decision circle(const Loop& loop) { return CircleCriterion(loop).circle().decision; }
Decision popov(const Loop& loop) { return CircleCriterion(loop).popov().decision; }

DeadZone<double> dead_zone(double half_width) {
  DeadZone<double> element;
  element.half_width = half_width;
  return element;
}

Cubic<double> cubic(double coefficient) {
  Cubic<double> element;
  element.coefficient = coefficient;
  return element;
}

}  // namespace

TEST_CASE("circle and Popov: limits of the gain in closed form") {
  // K/(s + 1)^3: Re G >= -K/4 (at w = 1), so that the circle allows K < 4, Popov all K < 8, where the linear loop ends.
  CHECK(CircleCriterion(forward(saturation(1.0), {2.0}, three_lags)).circle_margin().value ==
        Approx(0.5).epsilon(1e-9));
  CHECK(circle(forward(saturation(1.0), {4.0 - 1e-7}, three_lags)) == Decision::yes);
  CHECK(circle(forward(saturation(1.0), {4.0 + 1e-7}, three_lags)) == Decision::no);
  CHECK(popov(forward(saturation(1.0), {8.0 - 1e-5}, three_lags)) == Decision::yes);
  CHECK(popov(forward(saturation(1.0), {8.0 + 1e-5}, three_lags)) == Decision::no);
  // K/(s (s + 1)^2): Re G > -2 K; Popov K < 2.
  CHECK(circle(forward(saturation(1.0), {0.5 - 1e-7}, integrator_and_two_lags)) == Decision::yes);
  CHECK(circle(forward(saturation(1.0), {0.5 + 1e-7}, integrator_and_two_lags)) == Decision::no);
  CHECK(popov(forward(saturation(1.0), {2.0 - 1e-5}, integrator_and_two_lags)) == Decision::yes);
  CHECK(popov(forward(saturation(1.0), {2.0 + 1e-5}, integrator_and_two_lags)) == Decision::no);
}

TEST_CASE("circle and Popov: Popov's multiplier does what it says") {
  const Loop loop = forward(saturation(1.0), {7.0}, three_lags);
  const CircleCriterion criterion(loop);
  CHECK(criterion.circle().decision == Decision::no);
  REQUIRE(criterion.multiplier());
  CHECK(criterion.no_cycle().decision == Decision::yes);
  for (int i = 0; i <= 4000; ++i) {
    const double w = std::pow(10.0, -4.0 + i / 500.0);
    const std::complex<double> G = -loop.element_response(w)(0, 0);
    CHECK(1.0 + ((1.0 + std::complex<double>(0.0, w * *criterion.multiplier())) * G).real() > 0.0);
  }
}

TEST_CASE("circle and Popov: loops that oscillate are never cleared, nor elements outside their scope") {
  for (const Loop& loop : {forward(saturation(1.0), {10.0}, three_lags), forward(dead_zone(0.1), {10.0}, three_lags),
                           forward(saturation(1.0), {-1.0, 0.0}, {1.0, 0.8, 8.0}),    // Khalil's example
                           forward(cubic(1.0 / 3.0), {1.0, 0.0}, {1.0, -1.0, 1.0})})  // van der Pol
    CHECK(CircleCriterion(loop).no_cycle().decision == Decision::no);
  // Inside the dead zone the loop swings undamped: a cycle of any size up to it.
  CHECK(CircleCriterion(forward(dead_zone(0.1), {1.0, 0.0}, {1.0, 0.0, 4.0})).no_cycle().decision == Decision::no);
  CHECK(CircleCriterion(forward(relay(1.0), {1.0}, three_lags)).no_cycle().decision == Decision::not_applicable);
  CHECK(CircleCriterion(servo(lugre())).no_cycle().decision == Decision::not_applicable);
  CHECK(CircleCriterion(forward(cubic(-1.0), {1.0}, three_lags)).no_cycle().decision == Decision::not_applicable);
  CHECK(CircleCriterion(forward(cubic(1.0), {1.0}, {1.0, 1.0})).no_cycle().decision == Decision::yes);
  LoopParts late;
  late.plant = TransferFunction{{1.0}, {1.0, 1.0}, 0.5};
  late.element = saturation(1.0);
  CHECK(CircleCriterion(build_loop(late)).no_cycle().decision == Decision::undecided);
}

TEST_CASE("circle and Popov: a constant signal that no equilibrium can bear is left alone by Popov") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, integrator_and_two_lags, 0.0};
  parts.element = saturation(1.0);
  CHECK(popov(build_loop(parts)) == Decision::yes);
  parts.load = 3.0;  // more than the saturation gives: y diverges
  CHECK(popov(build_loop(parts)) == Decision::no);
}

TEST_CASE("circle criterion agrees with the error bands of the describing function, and neither with a cycle") {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  int cleared = 0, oscillating = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const double gain = std::pow(10.0, -1.0 + 2.5 * part(random)), a = 0.2 + 3.0 * part(random);
    const Loop loop =
        forward(trial % 2 ? Element(saturation(0.5)) : Element(dead_zone(0.1)),
                trial % 4 < 2 ? std::vector<double>{gain} : std::vector<double>{gain, gain * part(random)},
                {1.0, 1.0 + a, 1.0 + a, a});
    const CircleCriterion criterion(loop);
    const ErrorBand band(loop);
    const SearchBox box{1e-3, 1e3, 1e-2, 1e2};
    const bool absent = band.absence(box).verdict == BandVerdict::proved;
    INFO("trial " << trial << ", gain " << gain << ", a " << a << ": " << criterion.circle().why);
    if (criterion.circle().decision == Decision::yes) CHECK(absent);
    SettleOptions options;
    options.max_steps = 3000;
    const bool cycle = settle(loop, displaced(loop, 1.0), options).outcome == Outcome::cycle;
    CHECK_FALSE((cycle && criterion.no_cycle().decision == Decision::yes));
    cleared += criterion.no_cycle().decision == Decision::yes;
    oscillating += cycle;
  }
  CHECK(cleared >= 5);
  CHECK(oscillating >= 2);
}
