#include "limcycle/reports/store/status.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "limcycle/reports/format/number.hpp"
#include "limcycle/tests/lines.hpp"
#include "limcycle/tests/reports/store/store_samples.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Four of six points, 2 a second.
StoredSweep half_done() {
  StoredSweep sweep;
  sweep.identity = test::sweep_identity(6);
  sweep.known = {true, false, true, true, true, false};
  sweep.rows = {1.0, 0.5,      none, none, none, none, 0.0,  1.5,  none,
                1.0, infinite, none, 1.0,  -8.0, none, none, none, none};
  sweep.activity = {
      .known = 4, .sessions = 2, .session_rows = 3, .began = 1000.0, .written = 1001.5, .running = true, .pid = 42};
  return sweep;
}

}  // namespace

TEST_CASE("columns are summed up over the finite values of the known points") {
  const auto columns = column_summaries(half_done());
  REQUIRE(columns.size() == 3);
  CHECK(columns[0].name == "verdict");
  CHECK(columns[0].finite == 4);
  CHECK(columns[0].mean == Approx(0.75).epsilon(1e-15));
  CHECK(columns[1].finite == 3);
  CHECK(columns[1].minimum == -8.0);
  CHECK(columns[1].maximum == 1.5);
  CHECK(columns[1].mean == Approx(-2.0).epsilon(1e-15));
  CHECK(columns[2].finite == 0);
  CHECK(std::isnan(columns[2].mean));
  StoredSweep large = half_done();
  for (const std::size_t i : {0U, 6U, 9U, 12U}) large.rows[i] = i < 7 ? 1.7e308 : -1.7e308;
  CHECK(std::abs(column_summaries(large)[0].mean) < 1e294);  // the mean is 0, and no sum is formed that overflows
}

TEST_CASE("the status of a store in words: how far, how fast, who, and what to do") {
  StoredSweep sweep = half_done();
  CHECK(seconds_left(sweep) == Approx(1.0));
  const std::string text = status_text("a.store", sweep, 1004.0);
  CHECK_THAT(text, Contains("a servo") && Contains("a.store, map: 4 of 6 points known (66.7 %)") &&
                       Contains("Process 42 is computing.") && Contains("3 points stored, 2.00 a second") &&
                       Contains("1 s left") && Contains("\nLast written 3 s ago.\n") &&
                       Contains("Provisional results") && Contains("-8.00000"));
  for (const auto& line : test::lines_of(text)) CHECK(line.size() <= 81);  // one letter of the title has two bytes
  sweep.activity.running = false;
  CHECK_THAT(status_text("a.store", sweep, 1004.0), Contains("continue by the same command with --resume"));
  sweep.known.assign(6, true);
  sweep.activity.known = 6;
  CHECK(seconds_left(sweep) == 0.0);
  CHECK_THAT(status_text("a.store", sweep, 0.0),
             Contains("Complete.") && !Contains("Provisional") && !Contains(" left"));
  sweep.known.assign(6, false);
  sweep.activity = {
      .known = 0, .sessions = 1, .session_rows = 0, .began = 5.0, .written = 5.0, .running = true, .pid = 0};
  CHECK(std::isnan(seconds_left(sweep)));
  CHECK_THAT(status_text("a.store", sweep, 6.0),
             Contains("Another process is computing") && !Contains("a second") && !Contains("esults"));
}

TEST_CASE("the documents of a status are those of the store") {
  const StoredSweep sweep = half_done();
  Provenance program;
  program.version = "9.9";
  const auto document = nlohmann::json::parse(status_json(program, "a.store", sweep));
  CHECK(document["command"] == "status");
  CHECK(document["case"]["sha256"] == std::string(64, 'a'));
  CHECK(document["provenance"]["version"] == "9.9");
  CHECK(document["provenance"]["seed"] == 18446744073709551615U);
  CHECK(document["sweep"]["version"] == "0.1.0");
  CHECK(document["known"] == 4);
  CHECK(document["rate"] == 2.0);
  CHECK(document["seconds_left"] == 1.0);
  CHECK(document["columns"][1]["minimum"] == -8.0);
  CHECK(document["columns"][2]["mean"].is_null());
  CHECK(status_csv(sweep) == "point,verdict,amplitude,period\n0,1,0.5,\n2,0,1.5,\n3,1,,\n4,1,-8,\n");
}

TEST_CASE("times to wait for are rounded up") {
  CHECK(as_waiting_time(0.0) == "0 s");
  CHECK(as_waiting_time(0.1) == "1 s");
  CHECK(as_waiting_time(59.5) == "1 min 00 s");
  CHECK(as_waiting_time(185.0) == "3 min 05 s");
  CHECK(as_waiting_time(7440.0) == "2 h 04 min");
  CHECK(as_waiting_time(3 * 86400.0 + 3600.0) == "3 d 01 h");
  CHECK(as_waiting_time(none) == "?");
  CHECK(as_waiting_time(infinite) == "?");
  CHECK(as_waiting_time(-1.0) == "?");
}
