#include "limcycle/analysis/energy/passivity/bounds.hpp"

#include <catch2/catch.hpp>

#include "limcycle/models/laws.hpp"
#include "limcycle/tests/friction_samples.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

BoundsOptions search(double top_speed, int inputs) {
  BoundsOptions options;
  options.top_speed = top_speed;
  options.inputs = inputs;
  return options;
}

}  // namespace

TEST_CASE("no input exceeds the bounds of any law") {
  FrictionLaws::for_each([]<template <class> class Kind>() {
    for_samples<Kind>([](auto law, const Sample& sample) {
      INFO(law.kind << " " << sample.name);
      const Bounds found = bounds(Element(law), search(1.0, 8));
      CHECK(found.status == Status::converged);
      CHECK(found.seen.inputs == 8);
      CHECK(found.force.kind != BoundKind::searched);
      CHECK(found.force.value >= 0.0);
      CHECK(found.seen.force <= found.force.value * (1.0 + 1e-7));
      CHECK(found.seen.force >= 0.4 * found.force.value);
      REQUIRE(found.states.size() == static_cast<std::size_t>(law.states()));
      for (std::size_t i = 0; i < found.states.size(); ++i) {
        const StateBound& bound = found.states[i];
        const double slack = 1e-7 * (bound.high - bound.low);
        CHECK(found.seen.low[i] >= bound.low - slack);
        CHECK(found.seen.high[i] <= bound.high + slack);
      }
    });
  });
}

TEST_CASE("the state of laws with one state has its sharp bound") {
  const auto bound_of = [](const Element& law, double speed = infinite) {
    return bounds(law, search(speed, 0)).states.at(0);
  };
  const StateBound lugre = bound_of(made<LuGre<double>>(with(uneven, {{"sigma0", 1e5}, {"sigma1", 10.0}})));
  CHECK(lugre.kind == BoundKind::exact);
  CHECK(lugre.high == Approx(1.5e-5).epsilon(1e-12));
  CHECK(lugre.low == Approx(-1.2e-5).epsilon(1e-12));
  CHECK(bound_of(made<Dahl<double>>({{"Fc", 2.0}, {"sigma0", 1e4}, {"exponent", 0.5}})).high ==
        Approx(2e-4).epsilon(1e-12));
  CHECK(bound_of(made<BoucWen<double>>({{"k", 1.0}, {"D", 1.0}, {"beta", 1.0}, {"gamma", 3.0}, {"n", 2.0}})).high ==
        Approx(0.5).epsilon(1e-12));
  CHECK(bound_of(made<BoucWen<double>>({{"k", 1.0}, {"D", 1.0}, {"beta", -0.1}, {"gamma", 1.0}})).high == infinite);
  // A curve that is highest in sliding: the bound is max g/sigma0 if that speed may be reached.
  const auto hump = made<LuGreSpline<double>>({{"velocity", std::vector<double>{0.0, 1e-3, 2e-3}},
                                               {"coefficients", std::vector<double>{1.0, 1.0, 2.0, 1.0, 1.0}},
                                               {"sigma0", 1e5}});
  double highest = 0.0;
  for (int k = 0; k <= 200'000; ++k) highest = std::max(highest, hump.level(1e-8 * k));
  CHECK(bound_of(hump).high == Approx(highest / 1e5).epsilon(1e-9));
  CHECK(bound_of(hump, 5e-4).high == Approx(hump.level(5e-4) / 1e5).epsilon(1e-9));
}

TEST_CASE("the force of lugre is bounded up to a speed, and not over all") {
  const Element law = made<LuGre<double>>(with(bristle, {{"sigma1", root}, {"sigma2", 0.4}}));
  const double V = 0.5, g = 1.0;  // far beyond vs
  const ForceBound bound = bounds(law, search(V, 0)).force;
  CHECK(bound.kind == BoundKind::exact);
  CHECK(bound.value == Approx(-1.5 + root * V * (1.0 + 1.5 / g) + 0.4 * V).epsilon(1e-9));
  CHECK(std::abs(bound.v) == V);
  CHECK(bound.z * bound.v < 0.0);
  CHECK(bounds(law, search(infinite, 0)).force.value == infinite);
  CHECK(bounds(made<LuGre<double>>(bristle), search(infinite, 0)).force.value == Approx(1.5).epsilon(1e-12));
}

TEST_CASE("a search is the same for the same seed and tells how sharp a bound is") {
  const Element law = made<LuGre<double>>(with(bristle, {{"sigma1", root}}));
  const Bounds first = bounds(law, search(1.0, 30)), second = bounds(law, search(1.0, 30));
  CHECK(first.seen.force == second.seen.force);
  CHECK(first.seen.high == second.seen.high);
  CHECK(first.seen.force > 0.999 * first.force.value);
  CHECK(first.seen.high.at(0) > 0.999 * first.states.at(0).high);
  CHECK_THROWS_AS(bounds(law, search(-1.0, 0)), std::invalid_argument);
  CHECK_THROWS_AS(bounds(Relay<double>{}, search(1.0, 0)), std::invalid_argument);
}
