#include "limcycle/analysis/study/predict/work_share.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "limcycle/analysis/study/balance/roots/df_roots.hpp"
#include "limcycle/analysis/study/composite/composite_balance.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/analysis/study/predict/verdicts.hpp"
#include "limcycle/models/element/with_memory/backlash.hpp"
#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Catch::Matchers::Contains;

TEST_CASE("work share: grows with what the truth took, between a least and a most") {
  const WorkShare least = work_share(0), some = work_share(80'000), most = work_share(100'000'000);
  CHECK(least.composite_steps == work_share(1000).composite_steps);
  CHECK(some.composite_steps >= least.composite_steps);
  CHECK(most.composite_steps >= some.composite_steps);
  CHECK(most.check_steps > least.check_steps);
  CHECK(most.composite_steps == work_share(200'000'000).composite_steps);
  CHECK(most.check_steps >= some.check_steps);
  CHECK(most.df_evaluations >= some.df_evaluations);
  CHECK(most.balance_evaluations >= some.balance_evaluations);
}

TEST_CASE("work share: a composite search ends when its steps are used up, break-away forces included, and says so") {
  for (const Loop& loop : {servo(lugre()), belt(lugre())}) {
    CompositeSearchOptions options;
    options.max_steps = 20'000;
    CompositeBalance balance(loop);
    const CompositeSearch found = balance.find(options);
    CHECK(found.status == Status::incomplete);
    CHECK(found.steps < 2 * options.max_steps);
    REQUIRE_FALSE(found.notes.empty());
    CHECK_THAT(found.notes.front(), Contains("step limit reached, solutions may be missing"));
  }
}

TEST_CASE("work share: a root search ends when its describing functions are used up, and says so") {
  const Loop loop = servo(lugre());
  const FirstHarmonicBalance balance(loop);
  const SearchBox box{1e-6, 1.0, 0.01, 1000.0};
  const DfRoots found = find_df_roots(loop, balance, box, {}, 20'000);
  CHECK(found.status == Status::incomplete);
  REQUIRE_FALSE(found.notes.empty());
  CHECK_THAT(found.notes.front(), Contains("step limit reached"));
  CHECK(balance.evaluations() < 200'000);  // of the first grid, some hundred values at once
}

TEST_CASE("work share: what was cut short is listed as incomplete, so that nothing is called missed") {
  const PredictReport report = predict(belt(lugre()));
  REQUIRE_FALSE(report.cycles.empty());
  CHECK_FALSE(searched_completely(report, "composite-describing-function"));
  CHECK(searched_completely(report, "describing-function"));
}

TEST_CASE("work share: a search for an unstable cycle takes nothing from the simulations of other predictions") {
  Backlash<double> gap;
  gap.half_gap = 9.04157;
  gap.slope = 2.96817;
  // Poles at 0, -39.1311 and -114.382 rad/s. Shooting from the border with the rest in the gap is in vain and long.
  const PredictReport report = predict(forward(gap, {139270.0}, {1.0, 153.5131, 39.1311 * 114.382, 0.0}));
  REQUIRE(report.predictions.size() >= 2);
  CHECK(report.predictions[1].stable == true);
  CHECK(report.predictions[1].verdict == Verdict::confirmed);
  CHECK(std::ranges::any_of(report.outcomes, [](const OutcomeOfStart& one) { return one.start == "prediction 1"; }));
}
