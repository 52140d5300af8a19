#include "limcycle/analysis/study/predict.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "limcycle/analysis/study/loop_balance.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

PredictReport predicted(const Loop& loop, std::optional<SearchBox> box = {}) {
  PredictOptions options;
  options.search = box;
  return predict(loop, options);
}

}  // namespace

TEST_CASE("the hunting servo: the describing function sees nothing, the truth is one stable cycle, which is missed") {
  const auto report = predicted(servo(lugre()), SearchBox{1e-6, 1.0, 0.01, 1000.0});
  CHECK(report.predictions.empty());
  REQUIRE(report.cycles.size() == 1);
  CHECK(report.cycles[0].period == Approx(24.436786455993).epsilon(1e-8));
  REQUIRE(report.missed.size() == 1);
  CHECK(report.missed[0].cycle == 0);
  CHECK(report.status == Status::converged);
}

TEST_CASE("without stiction the servo has no cycle from any start") {
  const auto report = predicted(servo(lugre(1.0, 1.0)), SearchBox{1e-6, 1.0, 0.01, 1000.0});
  CHECK(report.cycles.empty());
  CHECK(report.predictions.empty());
  for (const auto& outcome : report.outcomes) CHECK(outcome.outcome == Outcome::rest);
}

TEST_CASE("relay loops are confirmed, with the numbers of claim B1, and roots solve the balance they came from") {
  const Loop loop = forward(relay(1.0), {1.0}, {1.0, 3.0, 3.0, 1.0});
  const auto report = predicted(loop);
  REQUIRE(report.predictions.size() == 1);
  const Prediction& p = report.predictions[0];
  CHECK(p.frequency == Approx(std::sqrt(3.0)).epsilon(1e-9));
  CHECK(p.amplitude == Approx(0.5 / std::numbers::pi).epsilon(1e-9));
  CHECK(p.stable == true);
  CHECK(p.verdict == Verdict::confirmed);
  CHECK(std::abs(LoopBalance(loop)(p.input_amplitude, p.frequency, 1e-12)) < 1e-9);
}

TEST_CASE("relay with dead zone: the unstable cycle between rest and the stable one is found too") {
  const auto report = predicted(forward(relay(1.0, 0.0, 0.05), {1.0}, {1.0, 3.0, 3.0, 1.0}));
  REQUIRE(report.predictions.size() == 2);
  REQUIRE(report.cycles.size() == 2);
  CHECK(report.missed.empty());
  for (const auto& p : report.predictions) {
    REQUIRE(p.cycle);
    CHECK(report.cycles[*p.cycle].stable == p.stable);
    CHECK(p.verdict == (*p.stable ? Verdict::confirmed : Verdict::biased));
  }
}

TEST_CASE("belt with LuGre, no viscous part: the describing function is far off and is called biased") {
  const auto report = predicted(belt(lugre(1.5, 1.0, 0.0)), SearchBox{1e-3, 10.0, 0.1, 10.0});
  REQUIRE(report.predictions.size() == 1);
  CHECK(report.predictions[0].verdict == Verdict::biased);
  REQUIRE(report.predictions[0].cycle);
  const Cycle& cycle = report.cycles[*report.predictions[0].cycle];
  CHECK(cycle.period == Approx(7.49381).epsilon(1e-6));
  CHECK(report.predictions[0].amplitude < 0.5 * cycle.first_harmonic);
}

TEST_CASE("dead time: every root of the phase condition in the box, none of them checked or called stable") {
  LoopParts parts;
  parts.plant = TransferFunction{{1.0}, {1.0, 1.0}, 0.5};
  parts.element = relay(1.0);
  const auto report = predicted(build_loop(parts), SearchBox{1e-4, 10.0, 0.1, 200.0});
  // Roots: 0.5 w + atan w = (2k + 1) pi, one for each k with w below 200.
  std::size_t expected = 0;
  while (0.5 * 200.0 + std::atan(200.0) > (2.0 * static_cast<double>(expected) + 1.0) * std::numbers::pi) ++expected;
  CHECK(report.predictions.size() == expected);
  for (const auto& p : report.predictions) {
    const double turns = (0.5 * p.frequency + std::atan(p.frequency)) / std::numbers::pi;
    CHECK(turns == Approx(std::round(turns)).epsilon(1e-9));
    CHECK(p.verdict == Verdict::undecided);
    CHECK_FALSE(p.stable);
  }
  CHECK(report.status == Status::incomplete);
}

TEST_CASE("a saturated command beside the friction is eliminated by its own describing function") {
  auto parts = servo_parts(coulomb(1.5, 1.0));
  auto limited = pid(3.0, 4.0, 6.0);
  limited.saturation = 1e6;  // never reached: as if it were not there
  parts.controller = limited;
  const Loop with = build_loop(parts), without = servo(coulomb(1.5, 1.0));
  const LoopBalance a(with), b(without);
  for (const double A : {1e-3, 0.1})
    for (const double w : {0.1, 2.0}) CHECK(std::abs(a(A, w, 1e-9) - b(A, w, 1e-9)) < 1e-9 * std::abs(b(A, w, 1e-9)));
}

TEST_CASE("a stop is obeyed and what was computed is kept") {
  PredictOptions options;
  int asked = 0;
  options.stop = [&asked] { return ++asked > 2000; };
  const auto report = predict(servo(lugre()), options);
  CHECK(report.status == Status::interrupted);
}
