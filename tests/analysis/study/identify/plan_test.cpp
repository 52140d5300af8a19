#include "limcycle/analysis/study/identify/plan.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/study/identify/identify.hpp"
#include "limcycle/analysis/study/identify/record/synthesize.hpp"
#include "limcycle/tests/analysis/study/identify/rigs.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

/// Plan for records of these kinds, made of `truth` with 1 % noise, a kind twice with other noise.
IdentifyPlan planned(const Element& truth, const std::vector<RecordKind>& kinds) {
  IdentifyRequest request;
  request.laws = {kind_named(std::string(truth.kind()))};
  request.plan = true;
  std::uint64_t seed = 1;
  for (const RecordKind kind : kinds)
    for (auto& record : synthesize(truth, {}, seed++))
      if (record.kind == kind) request.records.push_back(std::move(record));
  const IdentifyReport report = identify(request);
  REQUIRE(report.chosen);
  REQUIRE(report.laws[*report.chosen].plan);
  return *report.laws[*report.chosen].plan;
}

}  // namespace

TEST_CASE("plan: what it promises of one more record is what that record brings") {
  const auto truth = GENERATE(from_range(std::vector<Element>{stribeck_rig(), lugre_rig()}));
  INFO(truth.kind());
  const std::vector<RecordKind> known{RecordKind::steady_velocity, RecordKind::lag};
  const IdentifyPlan plan = planned(truth, known);
  CHECK_FALSE(plan.noise_is_assumed);
  CHECK(plan.noise == Approx(0.01).epsilon(0.1));
  REQUIRE(plan.records.size() == 4);
  for (const PlannedRecord& one : plan.records) {
    INFO(to_string(one.kind));
    auto kinds = known;
    kinds.push_back(one.kind);
    const IdentifyPlan then = planned(truth, kinds);
    REQUIRE(then.half_width.size() == one.half_width.size());
    for (std::size_t i = 0; i < one.half_width.size(); ++i) {
      INFO(i);
      REQUIRE(std::isfinite(one.half_width[i]) == std::isfinite(then.half_width[i]));
      CHECK(one.half_width[i] <= plan.half_width[i] * (1.0 + 1e-9));
      // Both are those of the number as it came out, and of the noise as it fell.
      if (!std::isfinite(one.half_width[i])) continue;
      CHECK(one.half_width[i] / std::abs(plan.values[i]) ==
            Approx(then.half_width[i] / std::abs(then.values[i])).epsilon(0.25));
    }
  }
}

TEST_CASE("plan: the same record once more narrows every number by the root of two") {
  const IdentifyPlan plan = planned(stribeck_rig(), {RecordKind::steady_velocity});
  const auto& again = plan.records.front();
  REQUIRE(again.kind == RecordKind::steady_velocity);
  for (std::size_t i = 0; i < again.half_width.size(); ++i)
    CHECK(again.half_width[i] == Approx(plan.half_width[i] / std::sqrt(2.0)).epsilon(0.05));
}

TEST_CASE("plan: a number that no record so far feels is narrowed by those that do") {
  const IdentifyPlan plan = planned(lugre_rig(), {RecordKind::steady_velocity});
  std::size_t sigma0 = 0;
  while (plan.values[sigma0] < 100.0) ++sigma0;  // the only large one
  CHECK(std::isinf(plan.half_width[sigma0]));
  for (const PlannedRecord& one : plan.records)
    CHECK(std::isfinite(one.half_width[sigma0]) == (one.kind != RecordKind::steady_velocity));
}
