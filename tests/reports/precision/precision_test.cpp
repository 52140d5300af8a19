#include "limcycle/reports/precision/precision.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "limcycle/tests/lines.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

WorkPoint made(const std::string& method, const std::string& setting, double error, double seconds, Quality quality,
               const std::string& why = {}) {
  WorkPoint point;
  point.method = method;
  point.setting = setting;
  point.error = error;
  point.seconds = seconds;
  point.evaluations = 1234;
  point.unit = "steps";
  point.quality = quality;
  point.status = quality == Quality::failed ? Status::not_finite : Status::converged;
  point.why = why;
  return point;
}

PrecisionReport sample() {
  PrecisionReport report;
  WorkChart chart;
  chart.question = "cycle";
  chart.answered = true;
  chart.made_by = "shooting";
  chart.verified_by = "simulation <with> fehlberg78";
  chart.agreement = 2e-12;
  chart.floor = 1e-11;
  chart.points = {made("rodas5p", "rtol 1e-03", 7e-5, 2.4e-3, Quality::right),
                  made("rodas5p", "rtol 1e-09", 1e-11, 0.024, Quality::right),
                  made("dopri5", "rtol 1e-03", 2e-4, 0.08, Quality::right),
                  made("harmonic-balance", "H = 1", not_known, 0.018, Quality::failed, "no balance was found"),
                  made("describing-function", "one harmonic", not_known, 0.2, Quality::wrong, "predicts no cycle"),
                  made("composite-describing-function", "one harmonic", 2.9, 0.4, Quality::biased, "too \"simple\"")};
  conclude(chart);
  report.cycle_chart = std::move(chart);
  report.stiffness.points = {{1e3, 49.0, made("rodas5p", "rtol 1e-04", 1e-5, 1e-3, Quality::right)},
                             {1e8, 24.0, made("rodas5p", "rtol 1e-04", 0.4, 2e-3, Quality::wrong, "irregular")},
                             {1e8, 24.0, made("dopri5", "rtol 1e-04", not_known, 0.9, Quality::too_slow, "gave up")}};
  report.stiffness.notes = {"sigma0 = 1e+08: a weaker check"};
  return report;
}

}  // namespace

TEST_CASE("precision report: the answer names the cheapest method for each error, and those that never are") {
  const auto answer = precision_answer(sample());
  CHECK_THAT(answer, Contains("cheapest for 1e-02 to 1e-04: rodas5p (rtol 1e-03), 2.4 ms; for 1e-06 to 1e-10: rodas5p "
                              "(rtol 1e-09), 24 ms.") &&
                         Contains("Never the best choice: dopri5, harmonic-balance, describing-function, "
                                  "composite-describing-function."));
  PrecisionReport none = sample();
  none.cycle_chart->answered = false;
  none.cycle_chart->why = "it rests";
  CHECK_THAT(precision_answer(none), Contains("no verified reference: it rests."));
}

TEST_CASE("precision report: text within 80 columns, failures with their reasons") {
  const auto text = precision_text("A title", sample(), Units{});
  CHECK_THAT(text, StartsWith("A title\n") && Contains("confirmed to 11 digits") && Contains("predicts no cycle") &&
                       Contains("H = 1 (failed): no balance was found") && Contains("too slow") && Contains("wrong"));
  for (const auto& line : test::lines_of(text)) CHECK(line.size() <= 80);
}

TEST_CASE("precision report: JSON and CSV keep every point, what does not exist is null or empty") {
  const auto document = nlohmann::ordered_json::parse(precision_json({}, sample()));
  CHECK(document["schema"] == "limcycle/1");
  CHECK(document["command"] == "precision");
  REQUIRE(document["points"].size() == 6);
  for (const char* key : {"question", "method", "setting", "error", "seconds", "evaluations", "status", "why"})
    CHECK(document["points"][0].contains(key));
  CHECK(document["points"][3]["error"].is_null());
  CHECK(document["points"][3]["status"] == "failed");
  CHECK(document["points"][3]["method_status"] == "not_finite");
  CHECK(document["points"][4]["status"] == "wrong");
  CHECK(document["front"] == nlohmann::ordered_json::array({0, 1}));
  CHECK(document["reference"][0]["agreement"] == 2e-12);
  CHECK(document["stiffness"].size() == 3);
  CHECK(document["stiffness"][2]["sigma0"] == 1e8);
  const auto csv = precision_csv(sample());
  CHECK_THAT(csv, StartsWith("question,sigma0,method,setting,error,") &&
                      Contains("cycle,,harmonic-balance,H = 1,,,0.018,1234,steps,failed,not_finite,false") &&
                      Contains("stiffness,1e+08,dopri5") && Contains("\"too \"\"simple\"\"\""));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 10);
}

TEST_CASE("precision report: the page carries its figures as data, escaped") {
  const auto page = precision_page(sample(), {}, "case", Units{});
  CHECK_THAT(page, Contains("data-figure=\"work-cycle\"") && Contains("data-figure=\"work-stiffness\"") &&
                       Contains("simulation &lt;with&gt; fehlberg78") && !Contains("<with>"));
  const auto begin = page.find("id=\"data-work-cycle\">") + 21;
  const auto data = nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  REQUIRE(data["series"].size() == 6);  // five methods and the front
  CHECK(data["series"][2]["good"][0] == false);
  CHECK(data["series"][2]["y"][0].get<double>() > 2.9);  // no error: above all others
  CHECK(data["series"][5]["name"] == "Pareto front");
}

TEST_CASE("durations are readable") {
  CHECK(as_duration(2.36e-3) == "2.4 ms");
  CHECK(as_duration(13e-6) == "13 us");
  CHECK(as_duration(1.25) == "1.2 s");
  CHECK(as_duration(not_known) == "-");
}
