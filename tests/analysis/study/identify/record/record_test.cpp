#include "limcycle/analysis/study/identify/record/record.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

using namespace limcycle;
using Catch::Matchers::Contains;

namespace {

/// x = A sin wt, with its velocity.
FrictionRecord oscillation(std::size_t rows) {
  FrictionRecord record{RecordKind::pre_sliding, "loop.csv", {}, {}, {}, {}, 0.0};
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = 0.01 * static_cast<double>(i);
    record.t.push_back(t);
    record.x.push_back(1e-3 * std::sin(5.0 * t));
    record.v.push_back(5e-3 * std::cos(5.0 * t));
    record.F.push_back(2.0 * std::sin(5.0 * t) + 0.001 * static_cast<double>(i % 7));
  }
  return record;
}

std::string refusal_of(const FrictionRecord& record) {
  try {
    prepare(record, false);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("record: pieces have the measured displacement, and one sign of the velocity each") {
  for (const bool position : {true, false})
    for (const bool velocity : {true, false}) {
      if (!position && !velocity) continue;
      FrictionRecord record = oscillation(301);
      const double moved = record.x.back() - record.x.front();
      if (!position) record.x.clear();
      if (!velocity) record.v.clear();
      const PreparedRecord prepared = prepare(record, false);
      CHECK(prepared.compared.back().x == Approx(moved).epsilon(position ? 1e-12 : 1e-3));
      CHECK(prepared.compared.size() == 301);
      double duration = 0.0;
      for (const auto& piece : prepared.pieces) {
        duration += piece.duration;
        const double middle = piece.velocity(0.5);
        for (const double s : {0.0, 0.25, 0.75, 1.0}) CHECK(piece.velocity(s) * middle >= -1e-12 * middle * middle);
      }
      CHECK(duration == Approx(3.0));
    }
}

TEST_CASE("record: bad data ends with a sentence that names file and row") {
  FrictionRecord record = oscillation(50);
  for (double& x : record.x) x *= 1e3;
  CHECK_THAT(refusal_of(record), Contains("loop.csv") && Contains("1e+03 times as far") && Contains("scale"));
  record = oscillation(50);
  record.t[20] = record.t[18];
  CHECK_THAT(refusal_of(record), Contains("time does not rise at row 21"));
  record = oscillation(2);
  CHECK_THAT(refusal_of(record), Contains("has 2 rows"));
  record = oscillation(50);
  for (auto* column : {&record.x, &record.v}) column->assign(50, 0.0);
  CHECK_THAT(refusal_of(record), Contains("does not move"));
  record = oscillation(50);
  for (std::size_t i = 0; i < record.x.size(); ++i) record.x[i] = 1e-3 * std::cos(37.0 * record.t[i]);
  CHECK_THAT(refusal_of(record), Contains("do not belong together"));
  record = oscillation(50);
  record.x.clear();
  record.v.clear();
  CHECK_THAT(refusal_of(record), Contains("position or velocity"));
  record = oscillation(50);
  record.kind = RecordKind::steady_velocity;
  record.v.assign(50, 0.0);
  CHECK_THAT(refusal_of(record), Contains("no row can be compared"));
}

TEST_CASE("record: rows at the limit of the force sensor are left out, once the limit is stated") {
  FrictionRecord record = oscillation(301);
  for (double& F : record.F) F = std::min(F, 1.5);
  PreparedRecord prepared = prepare(record, false);
  CHECK(prepared.compared.size() == 301);
  REQUIRE(prepared.notes.size() == 1);
  CHECK_THAT(prepared.notes.front(), Contains("state force_limit"));
  record.force_limit = 1.5;
  prepared = prepare(record, false);
  CHECK(prepared.compared.size() < 301);
  for (const auto& row : prepared.compared) CHECK(std::abs(row.measured) < 1.5);
  REQUIRE(prepared.notes.size() == 1);
  CHECK_THAT(prepared.notes.front(), Contains("force_limit"));
}

TEST_CASE("record: ideal Coulomb friction, at one of two forces throughout, can be compared") {
  FrictionRecord record = oscillation(301);
  for (std::size_t i = 0; i < record.F.size(); ++i) record.F[i] = std::copysign(2.0, record.v[i]);
  CHECK(prepare(record, true).compared.size() == 301);
}

TEST_CASE("record: break-away is read off the line through the force at rest") {
  FrictionRecord record{RecordKind::break_away, "ramp.csv", {}, {}, {}, {}, 0.0};
  for (int i = 0; i < 100; ++i) {
    const double t = 0.01 * i;
    record.t.push_back(t);
    record.v.push_back(i < 60 ? 0.0 : 0.1 * (t - 0.59));
    record.F.push_back(i < 60 ? 3.0 * t : 1.0);
  }
  const PreparedRecord prepared = prepare(record, true);
  REQUIRE(prepared.break_aways.size() == 1);
  CHECK(prepared.break_aways.front().F == Approx(3.0 * 0.59));
  CHECK(prepared.break_aways.front().forward);
  CHECK(prepared.compared.size() == 40);

  record.skip = 0.58;  // leaves rows 59 and 60 of those at rest
  CHECK(prepare(record, true).break_aways.empty());
  record.skip = 0.0;
  record.kind = RecordKind::pre_sliding;
  CHECK(prepare(record, true).break_aways.empty());
  // Positions from an encoder stand still between its steps, the body does not.
  record.kind = RecordKind::break_away;
  for (std::size_t i = 0; i < record.t.size(); ++i) record.x.push_back(std::floor(20.0 * record.t[i]) / 20.0);
  record.v.clear();
  CHECK(prepare(record, true).break_aways.empty());
}

TEST_CASE("record: of a long one every few rows are compared, and all move the law") {
  const PreparedRecord prepared = prepare(oscillation(10 * most_compared), false);
  CHECK(prepared.compared.size() <= most_compared);
  CHECK(prepared.pieces.size() >= 10 * most_compared - 1);
  CHECK(prepared.notes.size() == 1);
}

TEST_CASE("record: a force that pushes along the motion is refused, for it has the other sign") {
  FrictionRecord record = oscillation(301);
  for (std::size_t i = 0; i < record.F.size(); ++i) record.F[i] = 3.0 * record.v[i] / 5e-3;
  CHECK(refusal_of(record).empty());
  for (double& F : record.F) F = -F;
  CHECK_THAT(refusal_of(record), Contains("pushes along the motion") && Contains("scale = {force = -1.0}"));
}

TEST_CASE("record: a body at rest whose velocity is noisy rests, and breaks away once") {
  // A ramp of 1 N/s to 2 N, then sliding at 20 mm/s; noise of 0.1 mm/s.
  const auto ramp = [](double noise) {
    FrictionRecord record{RecordKind::break_away, "ramp.csv", {}, {}, {}, {}, 0.0};
    for (int i = 0; i < 400; ++i) {
      const double t = 0.01 * i;
      record.t.push_back(t);
      const bool slides = t > 2.0;
      record.v.push_back((slides ? 0.02 : 0.0) + noise * std::sin(12.9898 * i * i));
      record.F.push_back(slides ? 1.0 : t);
    }
    return record;
  };
  const PreparedRecord clean = prepare(ramp(0.0), true), noisy = prepare(ramp(1e-4), true);
  REQUIRE(clean.break_aways.size() == 1);
  REQUIRE(noisy.break_aways.size() == 1);
  CHECK(noisy.break_aways[0].F == Approx(clean.break_aways[0].F).epsilon(1e-9));
  CHECK(noisy.break_aways[0].forward);
  CHECK(noisy.compared.size() == clean.compared.size());
}

TEST_CASE("record: a velocity estimated from noisy positions is said to be uncertain, one from exact ones is not") {
  for (const bool noisy : {true, false}) {
    CAPTURE(noisy);
    FrictionRecord record = oscillation(301);
    record.v.clear();
    for (std::size_t i = 0; i < record.x.size() && noisy; ++i)
      record.x[i] += 1e-5 * std::sin(12.9898 * static_cast<double>(i * i));
    const auto notes = prepare(record, false).notes;
    const bool said = std::ranges::any_of(
        notes, [](const std::string& one) { return one.find("estimated from the position") != std::string::npos; });
    CHECK(said == noisy);
  }
}
