#include "limcycle/analysis/study/continuation/follow.hpp"

#include <catch2/catch.hpp>

#include "limcycle/tests/loops.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

std::optional<Loop> dead_zone_relay(double d) { return forward(relay(1.0, 0.0, d), {1.0}, {1.0, 3.0, 3.0, 1.0}); }

FollowOptions options(double from, double to, std::optional<double> own) {
  FollowOptions result;
  result.continuation.from = from;
  result.continuation.to = to;
  result.own = own;
  return result;
}

}  // namespace

TEST_CASE("follow: both cycles at the start lie on one branch, which is followed once") {
  const auto report = follow(dead_zone_relay, options(0.02, 0.2, 0.05));
  CHECK(report.status == Status::converged);
  CHECK(report.start == 0.05);
  REQUIRE(report.branches.size() == 1);
  CHECK(report.notes.empty());
}

TEST_CASE("follow: without a cycle at the start the range is scanned, and it is said") {
  const auto report = follow(dead_zone_relay, options(0.01, 0.2, 0.15));
  CHECK(report.status == Status::converged);
  CHECK(report.start < 0.0819);
  REQUIRE(report.branches.size() == 1);
  REQUIRE(report.notes.size() == 1);
  CHECK_THAT(report.notes[0], Catch::Matchers::Contains("no limit cycle was found at 0.15"));
  // An own value outside the range does not count: the range begins with a cycle.
  CHECK(follow(dead_zone_relay, options(0.01, 0.05, 7.0)).start == 0.01);
}

TEST_CASE("follow: no cycle anywhere is an answer") {
  auto wanted = options(0.1, 0.2, std::nullopt);
  wanted.scan = 2;
  const auto report = follow(dead_zone_relay, wanted);
  CHECK(report.status == Status::no_cycle);
  CHECK(report.branches.empty());
  CHECK_THROWS_AS(follow(dead_zone_relay, options(0.1, 0.1, std::nullopt)), std::invalid_argument);
}

TEST_CASE("follow: does a branch pass through a cycle?") {
  const auto report = follow(dead_zone_relay, options(0.02, 0.2, 0.05));
  REQUIRE(report.branches.size() == 1);
  const Branch& branch = report.branches[0];
  const BranchPoint& point = branch.points[branch.points.size() / 2];
  CHECK(passes(branch, point.parameter, point.cycle));
  Cycle other = point.cycle;
  other.amplitude *= 1.5;
  CHECK_FALSE(passes(branch, point.parameter, other));
  CHECK_FALSE(passes(branch, 0.5, point.cycle));
}
