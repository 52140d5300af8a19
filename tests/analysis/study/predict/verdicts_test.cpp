#include "limcycle/analysis/study/predict/verdicts.hpp"

#include <catch2/catch.hpp>

using namespace limcycle;

namespace {

Cycle known(double first_harmonic, double period, bool stable = true) {
  Cycle cycle;
  cycle.amplitude = cycle.first_harmonic = first_harmonic;
  cycle.period = period;
  cycle.stable = stable;
  return cycle;
}

Prediction root(double amplitude, double frequency) {
  Prediction p;
  p.amplitude = amplitude;
  p.frequency = frequency;
  p.stable = true;
  return p;
}

}  // namespace

TEST_CASE("a prediction within 5 % is confirmed, farther off it is biased") {
  const std::vector<Cycle> cycles{known(1.0, 6.283185307179586)};
  auto p = root(1.049, 1.0);
  compare(p, cycles, 0);
  CHECK(p.verdict == Verdict::confirmed);
  p = root(1.051, 1.0);
  compare(p, cycles, 0);
  CHECK(p.verdict == Verdict::biased);
  p = root(1.0, 0.94);
  compare(p, cycles, 0);
  CHECK(p.verdict == Verdict::biased);
  CHECK(p.cycle == 0U);
}

TEST_CASE("a prediction is about the nearest cycle, if that is not absurdly far") {
  const std::vector<Cycle> cycles{known(1.0, 6.28), known(0.1, 6.28)};
  CHECK(nearest(cycles, root(0.12, 1.0)) == 1U);
  CHECK(nearest(cycles, root(5.0, 1.0)) == 0U);
  CHECK_FALSE(nearest(cycles, root(50.0, 1.0)));
  CHECK_FALSE(nearest(cycles, root(1.0, 4.0)));
}

TEST_CASE("the same cycle found twice is one cycle, a cycle no prediction is about is missed") {
  std::vector<Cycle> cycles;
  CHECK(merge(cycles, known(1.0, 6.28)) == 0);
  CHECK(merge(cycles, known(1.0 + 1e-8, 6.28)) == 0);
  CHECK(merge(cycles, known(1.001, 6.28)) == 1);
  Prediction p = root(1.0, 1.0);
  p.cycle = 0;
  const auto missed = missed_by("describing-function", cycles, {p});
  REQUIRE(missed.size() == 1);
  CHECK(missed[0].cycle == 1);
}
