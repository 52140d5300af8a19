#include "limcycle/reports/adequacy/adequate.hpp"
#include "limcycle/models/friction/dry/coulomb.hpp"
#include "limcycle/tests/lines.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace limcycle;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

AdequatePoint made(const std::string& law, const std::string& method, const std::string& verdict, double period,
                   double error, bool within, const std::string& why = {}) {
  AdequatePoint point;
  point.law = law;
  point.method = method;
  point.answer.answered = !verdict.empty();
  point.answer.verdict = verdict;
  point.answer.period = period;
  point.answer.amplitude = point.answer.first_harmonic = period > 0.0 ? 0.06 : 0.0;
  point.answer.seconds = 0.002;
  point.answer.why = why;
  point.error = error;
  point.within = within;
  point.why = why;
  return point;
}

AdequateReport sample() {
  AdequateReport report;
  report.best = made("", "", "cycle", 24.4, 0.0, true).answer;
  report.verified = "to 1e-12 by a friend";
  Coulomb<double> law;
  law.Fc = law.Fs = law.Fc_minus = law.Fs_minus = 1.0;
  report.laws = {
      {"coulomb", law, "same Fc"}, {"coulomb + stiction", law, "same <Fs>"}, {"dahl", {}, "not possible: no"}};
  report.laws[1].own = true;
  report.points = {made("coulomb", "shooting", "rest", 0.0, INFINITY, false, "ends in rest, although a cycle exists"),
                   made("coulomb + stiction", "describing-function", "no cycle", 0.0, INFINITY, false,
                        "finds no cycle, although a cycle exists"),
                   made("coulomb + stiction", "harmonic-balance", "", 0.0, not_known, false, "no balance"),
                   made("coulomb + stiction", "shooting", "cycle", 24.0, 0.017, true)};
  report.points.back().worst = 0.038;
  report.points.back().worst_at = "Fs +10 %";
  report.least = 1;
  report.cheapest = 3;
  report.spread = {"Fs -10 %", "Fs +10 %"};
  return report;
}

}  // namespace

TEST_CASE("adequate report: one sentence says what is enough, why less is not, and which methods fail") {
  CHECK_THAT(adequate_answer(sample(), Units{}),
             Contains("Simplest adequate model: the law coulomb + stiction with shooting (2.0 ms)") &&
                 Contains("within 5.0 % over the spread of the parameters (worst 3.8 %)") &&
                 Contains("The simpler law coulomb is not adequate: ends in rest, although a cycle exists.") &&
                 Contains("Not adequate with it: DF (finds no cycle, although a cycle exists), HB (no answer).") &&
                 Contains("confirmed to 1e-12 by a friend"));
  AdequateReport none = sample();
  none.least = none.cheapest = std::nullopt;
  CHECK_THAT(adequate_answer(none, Units{}), StartsWith("No law of the ladder stays within 5.0 %"));
  none.status = Status::undefined;
  none.why = "it is undecided";
  CHECK(adequate_answer(none, Units{}) == "There is no reference: it is undecided.");
}

TEST_CASE("adequate report: text within 80 columns with the whole ladder and its rules") {
  const auto text = adequate_text("A title", sample(), Units{});
  CHECK_THAT(text, StartsWith("A title\n") && Contains("no law") && Contains("not possible: no") && Contains("1.7 %") &&
                       Contains("CPU time of an answer") && Contains("Fs +10 %"));
  for (const auto& line : test::lines_of(text)) CHECK(line.size() <= 80);
}

TEST_CASE("adequate report: JSON, CSV and page") {
  const auto document = nlohmann::ordered_json::parse(adequate_json({}, sample()));
  CHECK(document["schema"] == "limcycle/1");
  CHECK(document["command"] == "adequate");
  CHECK(document["law"] == "coulomb + stiction");
  CHECK(document["method"] == "shooting");
  CHECK(document["laws"][2]["possible"] == false);
  CHECK(document["laws"][2]["kind"].is_null());
  REQUIRE(document["points"].size() == 4);
  CHECK(document["points"][1]["error"].is_null());
  CHECK(document["points"][1]["verdict"] == "no cycle");
  CHECK(document["points"][2]["verdict"].is_null());
  CHECK(document["points"][3]["worst"] == 0.038);
  const auto csv = adequate_csv(sample());
  CHECK_THAT(csv, StartsWith("law,method,verdict,") && Contains("coulomb,shooting,rest,,,0.002,,,,false,"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 5);
  const auto page = adequate_page(sample(), {}, "case", Units{});
  CHECK_THAT(page, Contains("data-figure=\"work-ladder\"") && Contains("same &lt;Fs&gt;") && !Contains("<Fs>"));
}
