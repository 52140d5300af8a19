#include "limcycle/analysis/study/continuation/follow.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/models/element/with_memory/backlash.hpp"
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

TEST_CASE(
    "follow: a relay with dead time is followed over the set-point to where it switches no more, in closed form") {
  // T dy/dt + y = 2 u(t - d), u = +-1/2, about the set-point r: the period is the sum of a rise and a fall.
  constexpr double T = 3.0, d = 0.7, h = 0.1;
  const auto family = [](double r) -> std::optional<Loop> {
    LoopParts parts;
    parts.plant = TransferFunction{{2.0}, {T, 1.0}, d};
    parts.element = relay(0.5, h);
    parts.reference = r;
    return build_loop(parts);
  };
  const double late = std::exp(-d / T), amplitude = 1.0 - (1.0 - h) * late;
  const auto period = [&](double r) {
    const double high = 1.0 - (1.0 - r - h) * late, low = (1.0 + r - h) * late - 1.0;
    return T * std::log((1.0 - low) / (1.0 - r - h) * (1.0 + high) / (1.0 + r - h)) + 2.0 * d;
  };
  for (const double to : {0.8, 1.2}) {
    const auto report = follow(family, options(-0.3, to, 0.4));
    REQUIRE(report.branches.size() == 1);
    const Branch& branch = report.branches[0];
    for (const BranchEvent& event : branch.events) CHECK(event.type == BranchEvent::Type::end);
    CHECK(branch.points.front().parameter == Approx(-0.3));
    CHECK(branch.points.back().parameter == Approx(std::min(to, 1.0 - h)).epsilon(1e-4));
    for (const BranchPoint& point : branch.points) {
      if (point.parameter > 0.89) continue;
      CHECK(point.cycle.period == Approx(period(point.parameter)).epsilon(1e-7));
      CHECK(point.cycle.amplitude == Approx(amplitude).epsilon(1e-7));
    }
  }
}

TEST_CASE("follow: cycles in a backlash end where small motions grow no more, however slow they are there") {
  // Motions of the plant within the gap repeat themselves in any size at this gain of 1/(s (s + 1)^2).
  constexpr double neutral = 1.0945889641;
  const auto family = [](double gain) -> std::optional<Loop> {
    Backlash<double> play;
    play.half_gap = 0.5;
    return forward(play, {gain}, {1.0, 2.0, 1.0, 0.0});
  };
  const auto report = follow(family, options(0.3, 1.9, 1.5));
  REQUIRE(report.branches.size() == 1);
  const BranchEvent& end = report.branches[0].events.front();
  CHECK(end.parameter == Approx(neutral).epsilon(1e-9));
  CHECK_THAT(end.why, Catch::Matchers::Contains("there are cycles of any amplitude from 0.5"));
  for (const BranchPoint& point : report.branches[0].points) CHECK(point.parameter > neutral * (1.0 - 1e-9));
}
