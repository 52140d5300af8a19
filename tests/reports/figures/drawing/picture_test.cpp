#include "limcycle/reports/figures/drawing/picture.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <regex>

#include "limcycle/tests/reports/sample_report.hpp"

using namespace limcycle;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

TEST_CASE("the picture shows cycle and sticking within its frame") {
  const auto text = predict_picture(sample::hunting(), {});
  CHECK_THAT(text, StartsWith("<svg xmlns=") && EndsWith("</svg>\n"));
  CHECK_THAT(text, Contains("This loop hunts") && Contains("class=\"stuck\"") && Contains("friction force (N)") &&
                       Contains(">0.05</text>"));
  CHECK(text.size() < 60000);
  const std::regex point("[ML]([-0-9.]+),([-0-9.]+)");
  int points = 0;
  for (std::sregex_iterator one(text.begin(), text.end(), point), end; one != end; ++one, ++points) {
    const double x = std::stod((*one)[1]), y = std::stod((*one)[2]);
    REQUIRE((x >= 10.0 && x <= 750.0 && y >= 50.0 && y <= 306.0));
  }
  CHECK(points > 1000);
}

TEST_CASE("the picture of a loop without a cycle is its answer in words") {
  auto report = sample::hunting();
  report.cycles.clear();
  report.outcomes = {{"<b>", Outcome::rest, "", {}, {}}};
  const auto text = predict_picture(report, {});
  CHECK_THAT(text, Contains("This loop does not hunt"));
  CHECK(text.find("<path") == std::string::npos);
}

TEST_CASE("the picture of an irregular motion shows its last swings, once") {
  auto report = sample::hunting();
  OutcomeOfStart run{"y(0) = 1", Outcome::irregular, "", {}, {}};
  run.irregular.mean_period = 10.0;
  for (int i = 0; i <= 10000; ++i) {
    const double t = 0.01 * i;
    run.trace.t.push_back(t);
    for (auto* column : {&run.trace.y, &run.trace.rate, &run.trace.input, &run.trace.velocity, &run.trace.output})
      column->push_back(std::sin(0.2 * t * (1.0 + 0.001 * t)));
  }
  report.cycles.clear();
  report.outcomes = {run};
  const auto text = predict_picture(report, {});
  CHECK_THAT(text, Contains(">40</text>") && Contains(" L444.0,") && !Contains(">50</text>"));
}

TEST_CASE("a cycle that rings many times is drawn to its end") {
  auto report = sample::hunting();
  Trace& trace = report.cycles[0].trace;
  trace = {};
  for (int i = 0; i <= 20000; ++i) {
    const double t = 1e-3 * i, ringing = std::exp(-0.2 * t) * std::sin(20.0 * t);
    trace.t.push_back(t);
    trace.y.push_back(t < 10.0 ? t : 20.0 - t);
    for (auto* column : {&trace.rate, &trace.input, &trace.velocity, &trace.output}) column->push_back(ringing);
  }
  const auto text = predict_picture(report, {});
  CHECK_THAT(text, Contains(">40</text>") && Contains(" L444.0,"));  // two periods, to the right end of the frame
  CHECK(text.size() < 100000);
}
