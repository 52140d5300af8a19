#include "limcycle/reports/predict/verdict_text.hpp"

#include <catch2/catch.hpp>

using namespace limcycle;
using Catch::Matchers::Contains;

namespace {

/// A loop that hunts, and a describing function that finds nothing.
PredictReport hunting_unseen() {
  PredictReport report;
  Cycle cycle;
  cycle.period = 2.0;
  cycle.amplitude = cycle.first_harmonic = 0.1;
  cycle.stable = true;
  report.cycles.push_back(cycle);
  report.missed.push_back({"describing-function", 0});
  return report;
}

std::string worth(const PredictReport& report) {
  const auto sentences = answer(report, {}).worth;
  REQUIRE(sentences.size() == 1);
  return sentences[0];
}

}  // namespace

TEST_CASE("a method whose search was complete does not find the cycle, one whose search was not may have missed it") {
  auto report = hunting_unseen();
  CHECK_THAT(worth(report), Contains("does not find this cycle"));
  report.incomplete.emplace_back("describing-function");
  CHECK_THAT(worth(report), Contains("its search was incomplete: it may have missed this cycle"));
  CHECK_THAT(worth(report), !Contains("does not find"));
}

TEST_CASE("what an incomplete search did find is told with its doubt") {
  auto report = hunting_unseen();
  Prediction other;
  other.amplitude = 0.3;
  other.frequency = 1.0;
  report.predictions.push_back(other);
  report.incomplete.emplace_back("describing-function");
  CHECK_THAT(worth(report), Contains("which is unverified") && Contains("it has not found the cycle that exists") &&
                                Contains("incomplete, so it may predict more"));
}

TEST_CASE("where nothing oscillates, an incomplete search that found nothing does not agree") {
  PredictReport report;
  report.outcomes.push_back({"y(0) = 1", Outcome::rest, "", {}, {}});
  report.describing_function = true;
  CHECK_THAT(worth(report), Contains("predicts none either"));
  report.incomplete.emplace_back("describing-function");
  CHECK_THAT(worth(report), Contains("found no limit cycle, but its search was incomplete."));
}

TEST_CASE("a loop that moves for ever without a period says so first, whatever unstable cycles it has") {
  auto report = hunting_unseen();
  report.cycles.front().stable = false;
  report.search = {1e-3, 10.0, 0.1, 100.0};
  OutcomeOfStart one{"y(0) = 1", Outcome::irregular, "", {}, {}};
  one.irregular = {0.868, 0.595, 0.593, 0.597, 200.0, 0.86, 0.85, 0.868};
  report.outcomes.push_back(one);
  const std::string verdict = answer(report, {}).what_happens;
  CHECK_THAT(verdict, Contains("This loop moves irregularly, without a period: from its only start"));
  CHECK_THAT(verdict, Contains("half-range 0.868 m, mean period 0.5950 s"));
  CHECK_THAT(verdict, Contains("An unstable limit cycle of period 2.000 s and amplitude 0.1000 m is not reached."));
}
