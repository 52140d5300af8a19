#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "limcycle/analysis/study/identify/identify.hpp"
#include "limcycle/analysis/study/sensitivity/global/random_stream.hpp"
#include "limcycle/tests/analysis/study/identify/rigs.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using namespace limcycle::test;

namespace {

constexpr double Fs = 12.0, Fc = 8.0, vs = 5e-3, sigma2 = 60.0, noise = 0.1;

double normal(RandomStream& draw) {
  const double radius = std::sqrt(-2.0 * std::log(draw.uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * draw.uniform());
}

/// Forces of a Stribeck curve at speeds between two, both ways.
FrictionRecord sweep(double slowest, double fastest, std::uint64_t seed) {
  RandomStream draw(seed, "sweep");
  FrictionRecord record{RecordKind::steady_velocity, "sweep.csv", {}, {}, {}, {}, 0.0};
  constexpr int speeds = 25;
  for (const double sign : {1.0, -1.0})
    for (int i = 0; i < speeds; ++i) {
      const double v = sign * slowest * std::pow(fastest / slowest, static_cast<double>(i) / (speeds - 1));
      const double level = Fc + (Fs - Fc) * std::exp(-(v / vs) * (v / vs));
      record.v.push_back(v);
      record.F.push_back(sign * level + sigma2 * v + noise * normal(draw));
    }
  return record;
}

const IdentifiedNumber& number(const IdentifiedLaw& law, const std::string& name) {
  return *std::ranges::find(law.numbers, name, &IdentifiedNumber::name);
}

IdentifiedLaw stribeck_of(const FrictionRecord& record) {
  IdentifyRequest request;
  request.laws = {kind_named("stribeck")};
  request.records = {record};
  return identify(request).laws.front();
}

}  // namespace

TEST_CASE("identify: speeds far below the Stribeck velocity do not determine the sliding level") {
  int outside = 0;  // of their intervals, as one in twenty is by chance
  for (int seed = 1; seed <= samples(8); ++seed) {
    CAPTURE(seed);
    const IdentifiedLaw law = stribeck_of(sweep(1e-6, 2e-4, static_cast<std::uint64_t>(seed)));
    CHECK_FALSE(number(law, "Fc").identifiable);
    CHECK_FALSE(number(law, "vs").identifiable);
    outside += number(law, "vs").high.value_or(1.0) < vs;
    outside += number(law, "Fc").low.value_or(0.0) > Fc;
  }
  CHECK(outside <= 2);
}

TEST_CASE("identify: speeds on both sides of the Stribeck velocity determine the levels") {
  for (int seed = 1; seed <= samples(8); ++seed) {
    CAPTURE(seed);
    const IdentifiedLaw law = stribeck_of(sweep(1e-4, 0.1, static_cast<std::uint64_t>(seed)));
    for (const auto& [name, value] : {std::pair("Fs", Fs), std::pair("Fc", Fc), std::pair("vs", vs)}) {
      CAPTURE(name);
      const IdentifiedNumber& one = number(law, name);
      REQUIRE(one.identifiable);
      const double half = 0.5 * (*one.high - *one.low);
      CHECK(std::abs(one.value - value) < 2.0 * half);  // four deviations
    }
  }
}
