#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/analysis/study/identify/free/synthesize_free.hpp"
#include "limcycle/analysis/study/identify/identify.hpp"
#include "limcycle/tests/analysis/study/identify/rigs.hpp"
#include "limcycle/tests/share.hpp"

using namespace limcycle;
using namespace limcycle::test;
using Catch::Matchers::Contains;

namespace {

FreeRig mass_rig(double mass = 1.0, double stiffness = 0.0) {
  return {model_of(Mass{.mass = mass, .stiffness = stiffness}), 0.0};
}

IdentifyReport fitted_to(const std::vector<FrictionRecord>& records, const FreeRig& rig,
                         const std::vector<std::string>& laws) {
  IdentifyRequest request{{}, records, {}, rig};
  for (const auto& kind : laws) request.laws.push_back(kind_named(kind));
  return identify(request);
}

FrictionRecord only(const std::vector<FrictionRecord>& records, RecordKind kind) {
  return *std::ranges::find(records, kind, &FrictionRecord::kind);
}

}  // namespace

TEST_CASE("identify free: without noise the numbers come out to the error of the simulation") {
  for (const Element& truth : {coulomb_rig(), stribeck_rig(), lugre_rig()}) {
    INFO(truth.kind());
    const FreeRig rig = mass_rig();
    const auto records = synthesize_free(truth, rig, {.noise = 0.0}, 1, truth.states() > 0 ? 201 : 151);
    const auto report = fitted_to({only(records, RecordKind::free)}, rig, {std::string(truth.kind())});
    REQUIRE(report.chosen);
    CHECK(report.shooting == Shooting::single);
    CHECK(report.records.size() == 2);
    for (const auto& one : report.laws.front().numbers) {
      INFO(one.name);
      CHECK(one.identifiable);
      CHECK(one.value == Approx(true_value(truth, one.name)).epsilon(2e-4));
    }
    CHECK(report.laws.front().march_error < 1.0);
    CHECK(report.laws.front().start_states == 2);
  }
}

TEST_CASE("identify free: 95 % intervals hold the true numbers as often as they say") {
  int inside = 0, all = 0;
  for (int i = 1; i <= samples(4); ++i) {
    const Element truth = i % 2 == 0 ? coulomb_rig() : stribeck_rig();
    const FreeRig rig = mass_rig();
    const auto records = synthesize_free(truth, rig, {}, static_cast<std::uint64_t>(i), 151);
    const auto report = fitted_to({only(records, RecordKind::free)}, rig, {std::string(truth.kind())});
    for (const auto& one : report.laws.front().numbers) {
      const double value = true_value(truth, one.name);
      ++all;
      inside += one.low && one.high && *one.low <= value && value <= *one.high ? 1 : 0;
    }
  }
  CHECK(inside >= 0.95 * all - 3.0 * std::sqrt(0.95 * 0.05 * all));
}

TEST_CASE("identify free: a decay on a spring gives Fc, and says that it does not give Fs") {
  const Element truth = law_with("coulomb", {{"Fc", 1.0}, {"Fs", 1.0}, {"sigma2", 0.5}});
  const FreeRig rig = mass_rig(1.0, 100.0);
  const auto decay = only(synthesize_free(truth, rig, {}, 3, 301), RecordKind::free_decay);
  CHECK(decay.F.empty());
  const auto report = fitted_to({decay}, rig, {"coulomb"});
  const auto& law = report.laws.front();
  REQUIRE(report.chosen);
  const auto& Fc = number_named(law, "Fc");
  CHECK(Fc.value == Approx(1.0).epsilon(0.02));
  CHECK(*Fc.high - *Fc.low < 0.1);
  CHECK_FALSE(number_named(law, "Fs").identifiable);
}

TEST_CASE("identify free: a decay from rest of which only the velocity was measured") {
  const Element truth = law_with("coulomb", {{"Fc", 1.0}, {"Fs", 1.0}, {"sigma2", 0.5}});
  const FreeRig rig = mass_rig(1.0, 100.0);
  auto decay = only(synthesize_free(truth, rig, {.noise = 0.0}, 3, 301), RecordKind::free_decay);
  decay.x.clear();
  const auto report = fitted_to({decay}, rig, {"coulomb"});
  REQUIRE(report.chosen);
  CHECK(number_named(report.laws.front(), "Fc").value == Approx(1.0).epsilon(1e-3));
  CHECK(number_named(report.laws.front(), "sigma2").value == Approx(0.5).epsilon(1e-2));
}

TEST_CASE("identify free: the same numbers in other units, and for the mirrored motion") {
  const Element truth = stribeck_rig();
  const auto record = only(synthesize_free(truth, mass_rig(), {}, 2, 151), RecordKind::free);
  const auto own = fitted_to({record}, mass_rig(), {"stribeck"});
  FrictionRecord other = record;  // mm, ms, kg: forces in kN
  for (double& one : other.t) one *= 1e3;
  for (double& one : other.x) one *= -1e3;
  for (double& one : other.v) one *= -1.0;
  for (double& one : other.F) one *= -1e-3;
  const auto changed = fitted_to({other}, mass_rig(), {"stribeck"});
  const std::pair<const char*, double> units[] = {{"Fs", 1e-3}, {"Fc", 1e-3}, {"vs", 1.0}, {"sigma2", 1e-3}};
  for (const auto& [name, unit] : units) {
    INFO(name);
    const auto &a = number_named(own.laws.front(), name), &b = number_named(changed.laws.front(), name);
    CHECK(b.value == Approx(unit * a.value).epsilon(2e-3));
    CHECK(*b.high - *b.low == Approx(unit * (*a.high - *a.low)).epsilon(0.05));
  }
}

TEST_CASE("identify free: beside a record of the force, each by its own noise") {
  const Element truth = stribeck_rig();
  const FreeRig rig = mass_rig();
  const auto motion = only(synthesize_free(truth, rig, {}, 4, 151), RecordKind::free);
  const auto sweep = synthesize(truth, {}, 4).front();
  const auto both = fitted_to({sweep, motion}, rig, {"stribeck"}), alone = fitted_to({sweep}, rig, {"stribeck"});
  REQUIRE(both.chosen);
  REQUIRE(both.records.size() == 3);
  CHECK(both.records[0].quantity == MeasuredQuantity::force);
  CHECK(both.records[1].quantity == MeasuredQuantity::position);
  CHECK(both.records[2].quantity == MeasuredQuantity::velocity);
  CHECK(both.laws.front().held_out == Approx(0.01).epsilon(0.15));
  for (const char* name : {"Fc", "Fs", "vs", "sigma2"}) {
    INFO(name);
    const auto &a = number_named(both.laws.front(), name), &b = number_named(alone.laws.front(), name);
    CHECK(*a.high - *a.low < *b.high - *b.low);  // more is known
    CHECK(a.value == Approx(true_value(truth, name)).epsilon(0.1));
  }
}

TEST_CASE("identify free: the right law among several, and the same bytes again") {
  const FreeRig rig = mass_rig();
  const auto record = only(synthesize_free(stribeck_rig(), rig, {}, 5, 151), RecordKind::free);
  const auto one = fitted_to({record}, rig, {"coulomb", "stribeck"}),
             two = fitted_to({record}, rig, {"coulomb", "stribeck"});
  REQUIRE(one.chosen);
  CHECK(one.laws[*one.chosen].law.kind() == "stribeck");
  CHECK(one.laws[0].bic == two.laws[0].bic);
  CHECK(one.laws[1].numbers[2].high == two.laws[1].numbers[2].high);
}

TEST_CASE("identify free: a motion that no law follows in one run is fitted in several, which is said") {
  // Somebody pushes the table: the mass on its spring drifts away from any simulation, but slowly.
  const Element truth = law_with("coulomb", {{"Fc", 1.0}, {"Fs", 1.0}});
  const FreeRig rig = mass_rig(1.0, 100.0);
  auto decay = only(synthesize_free(truth, rig, {.noise = 0.002}, 3, 301), RecordKind::free_decay);
  decay.v.clear();
  for (std::size_t i = 0; i < decay.t.size(); ++i) decay.x[i] += 0.05 * std::sin(0.9 * decay.t[i]);
  const auto report = fitted_to({decay}, rig, {"coulomb"});
  CHECK(report.shooting == Shooting::multiple);
  CHECK(report.laws.front().start_states > 10);
}

TEST_CASE("identify free: plants that cannot move freely here, and records that say nothing") {
  CHECK_THAT(*why_no_free_rig(model_of(TwoMass{.motor_mass = 1.0, .load_mass = 1.0, .stiffness = 1.0})),
             Contains("has 4 states"));
  CHECK_THAT(
      *why_no_free_rig(model_of(SecondOrder{.gain = 1.0, .time_constant = 1.0, .damping_ratio = 1.0, .delay = 0.1})),
      Contains("dead time"));
  CHECK_FALSE(why_no_free_rig(mass_rig().plant));
  FrictionRecord record{RecordKind::free, "r.csv", {}, {}, {}, {}, 0.0};
  for (int i = 0; i < 30; ++i) {
    record.t.push_back(0.1 * i);
    record.x.push_back(0.5);
    record.F.push_back(1.0);
  }
  const auto said = [&](const FrictionRecord& one) {
    try {
      prepare_free(one, mass_rig());
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(said(record), Contains("does not move"));
  auto other = record;
  other.t[7] = 0.0;
  CHECK_THAT(said(other), Contains("time does not rise at row 8"));
  other = record;
  other.F.clear();
  CHECK_THAT(said(other), Contains("needs a force column"));
  CHECK_THROWS_AS(identify({{kind_named("coulomb")}, {record}, {}}), std::invalid_argument);
}
