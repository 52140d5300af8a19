#include "limcycle/analysis/energy/passivity/supply_march.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "limcycle/analysis/energy/passivity/reference_march.hpp"
#include "limcycle/models/laws.hpp"
#include "limcycle/tests/friction_samples.hpp"

// Energy supplied to one element: closed forms, and the independent simulation.
using namespace limcycle;
using namespace limcycle::test;

namespace {

template <template <class> class Kind>
Element law_of(const Settings& settings) {
  return Element(made<Kind<double>>(settings));
}

}  // namespace

TEST_CASE("supply: the work of a fast step on LuGre's stretched bristle (claim D2)") {
  const auto law = law_of<LuGre>(with(bristle, {{"sigma1", root}}));
  SupplyMarch march(law, 1e-11);
  ElementPoint at{{1.5e-5}, {}, 0.0, 1.0};
  REQUIRE(march.cross({1e-5, 1.0, 1.0}, at) == Status::converged);
  // X = 1e-5 m at V = 1 m/s from z = Fs/sigma0, g = Fc, l = Fc/sigma0
  const double l = 1e-5, X = 1e-5, gone = l * -std::expm1(-X / l);
  CHECK(march.supplied() == Approx(1.0 * X + 0.5 * gone - root * 1.0 * 0.5 * gone).epsilon(1e-8));
  CHECK(march.supplied() == Approx(-9.86e-4).epsilon(1e-3));
}

TEST_CASE("supply: a loop of stop elements costs its area, whatever the speeds") {
  const auto law = law_of<MaxwellSlip>(four_stops);
  // Swing of 6e-5 m: 4 W (A - W/k) for each element that yields, A = 3e-5 m.
  double area = 0.0;
  const double A = 3e-5, k[] = {4e4, 2e4, 1e4, 5e3}, W[] = {0.3, 0.4, 0.4, 0.5};
  for (int i = 0; i < 4; ++i)
    if (A > W[i] / k[i]) area += 4.0 * W[i] * (A - W[i] / k[i]);
  for (const double v : {1e-9, 1e-4, 3.0}) {
    SupplyMarch march(law, 1e-9);
    const std::vector<SignalPiece> loop{{6e-5 / v, v, v}, {3.0 * 6e-5 / v, -v / 3.0, -v / 3.0}};
    const CycleSupply cycle = periodic_supply(march, loop, 20, 1e-9);
    REQUIRE(cycle.status == Status::converged);
    CHECK(cycle.supplied == Approx(area).epsilon(1e-9));
    CHECK(cycle.turnover > cycle.supplied);
  }
}

TEST_CASE("supply: the independent simulation agrees, through jumps, ramps and switches") {
  std::vector<Element> laws{law_of<LuGre>(with(bristle, {{"sigma1", root}, {"sigma2", 0.4}}))};
  for (const std::string_view kind : {"gms", "xiong", "non-drift", "leuven", "two-state", "wojewoda"})
    FrictionLaws::for_each([&]<template <class> class Kind>() {
      if (Kind<double>::kind == kind) laws.push_back(law_of<Kind>(samples_of_kind(kind).front().settings));
    });
  CHECK(laws.size() == 7);
  for (const auto& law : laws) {
    const double v = 1e-3, d = law.scales().displacement;
    const std::vector<SignalPiece> pieces{{3.0 * d / v, 0.5 * v, 1.5 * v},
                                          {d / v, 1.5 * v, -0.5 * v},
                                          {2.0 * d / v, -0.5 * v, -0.5 * v},
                                          {20.0 * d / v, -1e-2 * v, -2e-2 * v},
                                          {0.5 * d / v, -2.0 * v, -0.1 * v}};
    SupplyMarch march(law, 1e-10);
    ElementPoint at = march.virgin(pieces.front());
    const ElementPoint begin = at;
    for (int cycle = 0; cycle < 2; ++cycle)
      for (const auto& piece : pieces) {
        REQUIRE(march.settle(piece, at));
        REQUIRE(march.cross(piece, at) == Status::converged);
      }
    const auto other = reference_march(law, cycle_of(pieces), begin.z, begin.mode, 2);
    INFO(std::string(law.kind()));
    REQUIRE(other.status == Status::converged);
    // Both lose digits at a branch that begins with an infinite slope.
    CHECK(march.supplied() == Approx(other.supplied).epsilon(1e-6));
  }
}

TEST_CASE("supply: pieces and cycles say the same, and a cycle has its value at every time") {
  const std::vector<SignalPiece> pieces{{1.0, 0.5, 0.5}, {2.0, -1.0, 3.0}, {0.5, 3.0, 0.5}};
  const VelocityCycle cycle = cycle_of(pieces);
  CHECK(cycle.period() == 3.5);
  const auto again = pieces_of(cycle);
  REQUIRE(again.size() == pieces.size());
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    CHECK(again[k].duration == pieces[k].duration);
    CHECK(again[k].from == pieces[k].from);
    CHECK(again[k].to == pieces[k].to);
  }
  CHECK(cycle.at(0.3) == 0.5);
  CHECK(cycle.at(1.0) == -1.0);  // right-hand value at a jump
  CHECK(cycle.at(2.0) == Approx(1.0));
  CHECK(cycle.at(-0.25) == Approx(1.75));
  CHECK(cycle.at(3.5 + 2.0) == Approx(1.0));
}
