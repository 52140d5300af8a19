#include "limcycle/reports/experiments/experiment.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "limcycle/tests/lines.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

namespace {

Experiment sample() {
  Experiment e;
  e.name = "non-drift";
  e.title = "Does <it> drift?";
  e.document = "thesis, figure 1";
  e.input = "a force, and a comment that is long enough to be broken over more than one line of eighty columns of text";
  e.quantities = {{"drift", "drift a cycle", "m"}, {"peak", "peak", "N"}};
  e.rows = {{"lugre", "0.1 N/s", {4.75e-6, 1.5}}, {"coulomb", "0.1 N/s", {0.0, NAN}}};
  e.findings = {{"lugre", "drifts by 4.75e-06 m", Status::converged}, {"coulomb", "rests", Status::converged}};
  e.claims = {{"it drifts", "thesis", ClaimOutcome::confirmed, "by \"much\", truly"},
              {"it does not", "paper", ClaimOutcome::not_confirmed, "4 m"},
              {"it may", "paper", ClaimOutcome::not_tested, ""}};
  e.figures = {{"force-time", "Force & time", "t", "s", "F", "N", false, {}},
               {"rate", "Force over rate", "rate", "N/s", "F", "N", true, {}}};
  e.figures[0].panels = {
      {"lugre", {{"friction", {0.0, 1.0, 2.0}, {0.0, 1e-6, NAN}}, {"applied", {0.0, 2.0}, {0.0, 2e-6}}}},
      {"coulomb", {{"friction", {0.0, 1.0}, {1.0, 1.0}}}}};
  e.figures[1].panels = {{"lugre", {{"", {0.01, 1.0, 100.0}, {1.0, 2.0, 3.0}}}}};
  return e;
}

}  // namespace

TEST_CASE("experiment: text within 80 columns, with findings, numbers and claims") {
  const auto text = experiment_text({sample()});
  CHECK_THAT(text, StartsWith("non-drift: Does <it> drift?\n") && Contains("Findings\nlugre    drifts by 4.75e-06 m") &&
                       Contains("not confirmed  it does not (paper): 4 m") && Contains("4.7500e-06") &&
                       Contains("Of 2 claims tested, 1 confirmed, 1 not confirmed; 1 not tested"));
  for (const auto& line : test::lines_of(text)) CHECK(line.size() <= 80);
  // For several experiments: findings and claims only.
  CHECK(experiment_text({sample(), sample()}).find("4.7500e-06") == std::string::npos);
}

TEST_CASE("experiment: JSON and CSV carry numbers, findings, claims and curves") {
  const auto document = nlohmann::ordered_json::parse(experiment_json({}, {sample()}));
  CHECK(document["schema"] == "limcycle/1");
  CHECK(document["command"] == "experiment");
  const auto& one = document["experiments"][0];
  CHECK(one["rows"][0]["drift"] == 4.75e-6);
  CHECK(one["rows"][1]["peak"].is_null());
  CHECK(one["claims"][1]["outcome"] == "not confirmed");
  CHECK(one["figures"][0]["panels"][0]["curves"][0]["y"][2].is_null());
  const auto csv = experiment_csv({sample()});
  CHECK_THAT(csv, StartsWith("kind,experiment,law,setting,quantity,figure,curve,x,y,text\n") &&
                      Contains("number,non-drift,lugre,0.1 N/s,drift,,,,4.75e-06,\n") &&
                      Contains("number,non-drift,coulomb,0.1 N/s,peak,,,,,\n") &&
                      Contains("\"it drifts: by \"\"much\"\", truly\"") &&
                      Contains("trace,non-drift,lugre,,,force-time,applied,2,2e-06,\n"));
}

TEST_CASE("experiment: every point of a figure lies in its frame") {
  const auto figure = experiment_figure(sample().figures[0]);
  CHECK_THAT(figure, StartsWith("<svg xmlns=") && EndsWith("</svg>\n") && Contains("Force &amp; time") &&
                         Contains("F (1e-6 N)") && Contains(">friction</text>"));
  const std::regex frame("class=\"frame\" x=\"([0-9.]+)\" y=\"([0-9.]+)\" width=\"([0-9.]+)\" height=\"([0-9.]+)\"");
  std::smatch box;
  REQUIRE(std::regex_search(figure, box, frame));
  const double left = std::stod(box[1]), top = std::stod(box[2]), width = std::stod(box[3]), height = std::stod(box[4]);
  // The first panel's curves are those before the second frame.
  const auto second = figure.find("class=\"frame\"", static_cast<std::size_t>(box.position(0)) + 10);
  const std::string first =
      figure.substr(static_cast<std::size_t>(box.position(0)), second - static_cast<std::size_t>(box.position(0)));
  const std::regex point("[ML]([-0-9.]+) ([-0-9.]+)");
  int points = 0;
  for (std::sregex_iterator at(first.begin(), first.end(), point), end; at != end; ++at, ++points) {
    CHECK((std::stod((*at)[1]) >= left && std::stod((*at)[1]) <= left + width));
    CHECK((std::stod((*at)[2]) >= top && std::stod((*at)[2]) <= top + height));
  }
  CHECK(points == 4);  // one of five is not a number
  CHECK_THAT(experiment_figure(sample().figures[1]), Contains(">0.01</text>") && Contains(">100</text>"));
}

TEST_CASE("experiment: the page escapes, is small and says how to make it again") {
  Provenance made;
  made.version = "1";
  const auto page = experiment_page({sample()}, made, "--law lugre");
  CHECK_THAT(page, Contains("Does &lt;it&gt; drift?") && Contains("limcycle experiment non-drift --law lugre") &&
                       Contains("<svg") && Contains("class=\"left confirmed\""));
  CHECK(page.size() < 500'000);  // without the library that draws figures
  CHECK(page.find("SHA-256") == std::string::npos);
  CHECK_THAT(experiment_page({sample(), sample()}, made, ""), Contains("<a href=\"#non-drift\">"));
  CHECK_THAT(experiment_picture({sample()}), StartsWith("<svg") && Contains("Force over rate"));
}
