#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/orbit/cycle/measure.hpp"

using namespace limcycle;

TEST_CASE("harmonics of a cycle: a coarse trace has no false high ones") {
  // A sinusoid by 16 points and the cubics between them, whose error is (h/2)^4/24 = 6e-5.
  constexpr int points = 16;
  constexpr double amplitude = 3.0, frequency = 0.7, phase = 0.4;
  Cycle cycle;
  cycle.period = 2.0 * std::numbers::pi / frequency;
  for (int i = 0; i <= points; ++i) {
    const double t = cycle.period * i / points, angle = frequency * t + phase;
    cycle.trace.t.push_back(t);
    cycle.trace.y.push_back(2.0 + amplitude * std::sin(angle));
    cycle.trace.rate.push_back(amplitude * frequency * std::cos(angle));
    cycle.trace.input.push_back(cycle.trace.y.back());
    cycle.trace.velocity.push_back(cycle.trace.rate.back());
  }
  for (const auto& found : {output_harmonics(cycle, 199), input_harmonics(cycle, 199)}) {
    CHECK(found(0).imag() == Approx(2.0).epsilon(1e-4));
    CHECK(std::abs(found(1) - std::polar(amplitude, phase)) < 1e-3);
    for (int n = 2; n < found.size(); ++n) CHECK(std::abs(found(n)) < 2e-4);
  }
}
