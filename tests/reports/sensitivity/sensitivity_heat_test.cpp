#include <catch2/catch.hpp>
#include <cmath>

#include "limcycle/reports/figures/drawing/svg_parts.hpp"
#include "limcycle/reports/sensitivity/sensitivity.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;

namespace {

Estimate between(double low, double value, double high) {
  Estimate estimate;
  estimate.known = true;
  estimate.value = value, estimate.low = low, estimate.high = high;
  return estimate;
}

/// Two parameters on a lattice of 20 x 20 points; the loop hunts if the first one is in its upper half.
SensitivityReport half_hunts() {
  SensitivityReport report;
  for (const char* path : {"loop.friction.Fs", "loop.controller.kd"}) {
    SpreadParameter one;
    one.path = path;
    one.low = 1.0, one.high = 3.0;
    report.spread.parameters.push_back(one);
  }
  for (int i = 0; i < 20; ++i)
    for (int k = 0; k < 20; ++k) {
      const double x = 1.0 + 0.1 * (i + 0.5), y = 1.0 + 0.1 * (k + 0.5);
      const double hunts = i == 0 && k == 0 ? NAN : i >= 10 ? 1.0 : 0.0;
      report.sample.push_back({x, y, hunts, hunts > 0.0 ? 0.1 : NAN, 1.0});
    }
  OutputSensitivity hunts;
  hunts.output = "hunts";
  hunts.sobol.parameters = {{between(0.8, 0.9, 1.0), between(0.9, 0.95, 1.0), 9, 9},
                            {between(-0.1, 0.0, 0.1), between(0.0, 0.1, 0.2), 9, 9}};
  hunts.sobol.interactions = {{0, 1, between(-0.01, 0.02, 0.05), 9}};
  report.global.emplace();
  report.global->outputs.push_back(hunts);
  return report;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
  return found;
}

}  // namespace

TEST_CASE("heat map of hunting: shares of the loops in equally likely cells of the two numbers that decide most") {
  const SensitivityReport report = half_hunts();
  const std::string picture = hunting_heat_picture(report);
  CHECK(count(picture, "4 of 4 hunt") == 50);
  CHECK(count(picture, "0 of 4 hunt") == 49);
  CHECK(count(picture, "0 of 3 hunt") == 1);                             // one loop was undecided
  CHECK(count(picture, "fill=\"" + colour_of_share(1.0) + "\"") == 51);  // and one in the legend
  CHECK_THAT(picture, Contains("friction.Fs 1.20 to 1.40, controller.kd 1.00 to 1.20: 0 of 4 hunt"));
  CHECK_THAT(picture,
             Contains("aria-label=\"Share of the loops that hunt over loop.friction.Fs and loop.controller.kd\""));

  SensitivityReport few = report;
  few.sample.resize(30);
  CHECK(hunting_heat_picture(few).empty());
  SensitivityReport unknown = report;
  unknown.global->outputs.front().sobol.parameters[1].total = {};
  CHECK(hunting_heat_picture(unknown).empty());
  unknown.global.reset();
  CHECK(hunting_heat_picture(unknown).empty());
}

TEST_CASE("heat map of pairs: what cannot be told from 0 is faint, and names no finding") {
  SensitivityReport report = half_hunts();
  OutputSensitivity& hunts = report.global->outputs.front();
  const std::string picture = interactions_picture(report, hunts);
  CHECK(count(picture, "<rect") == 3);
  CHECK(count(picture, "class=\"faint\"") == 2);
  CHECK_THAT(picture, Contains("loop.friction.Fs alone: 0.900 (0.800 to 1.000)"));
  CHECK_THAT(picture, !Contains("the largest of a pair"));
  hunts.sobol.interactions.front().share = between(0.01, 0.02, 0.05);
  CHECK_THAT(interactions_picture(report, hunts),
             Contains("the largest of a pair is 0.02, loop.friction.Fs with loop.controller.kd"));
  hunts.sobol.interactions.front().share = {};
  CHECK_THAT(interactions_picture(report, hunts), Contains("class=\"none\""));
  hunts.sobol.interactions.clear();
  CHECK(interactions_picture(report, hunts).empty());
}
