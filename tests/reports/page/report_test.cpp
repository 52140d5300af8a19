#include "limcycle/reports/page/report.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <regex>

#include "limcycle/reports/figures/drawing/plotly.hpp"
#include "limcycle/reports/figures/harmonics_figure.hpp"
#include "limcycle/reports/page/case_in_page.hpp"
#include "limcycle/tests/reports/markup.hpp"
#include "limcycle/tests/reports/sample_report.hpp"

using namespace limcycle;
using Json = nlohmann::json;

namespace {

Provenance made() {
  Provenance from;
  from.version = "1.2.3";
  from.title = "a <servo>";
  from.file = "servo.toml";
  return from;
}

LoopReport nothing_but(PredictReport predicted) {
  LoopReport report;
  report.loop.plant = Mass{.mass = 1.0};
  report.loop.controller = Pid{};
  report.predict = std::move(predicted);
  report.margin.why_not = "No margin, for a reason.";
  report.remedy.why_not = "No remedy, for a reason.";
  report.sensitivity.why_not = "No sensitivity, for a reason.";
  report.map.why_not = "No map, <for> a reason.";
  report.energy.why_not = "No energy, for a reason.";
  report.dissipativity.why_not = "No dissipativity, for a reason.";
  report.precision.why_not = "No precision, for a reason.";
  return report;
}

/// The page without the library, which may contain anything.
std::string page(const LoopReport& report, const std::string& case_text = "a = 1 # </pre><script>bad()</script>") {
  std::string text = report_page(report, made(), case_text, {}, "--quick");
  const auto at = text.find(plotly_script());
  REQUIRE(at != std::string::npos);
  return text.erase(at, plotly_script().size());
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("report: a page in the order of a reader's questions, each section in the contents") {
  const std::string text = page(nothing_but(sample::hunting()));
  CHECK(test::markup_fault(text) == "");
  std::size_t last = text.find("This loop hunts");
  REQUIRE(last != std::string::npos);
  for (const char* id : {"part-cure", "part-loop", "part-cycles", "part-predictions", "part-starts", "part-sensitivity",
                         "part-map", "part-energy", "part-dissipativity", "part-precision", "part-notes"}) {
    CHECK(holds(text, std::string("<a href=\"#") + id + "\">"));
    const auto at = text.find(std::string("<section id=\"") + id + "\">\n<h2>");
    REQUIRE(at != std::string::npos);
    CHECK(at > last);
    last = at;
  }
  CHECK(text.find("<h2 id=\"origin\">") > last);
}

TEST_CASE("report: one heading of level 1, and no level is left out") {
  auto report = nothing_but(sample::trusted());
  report.predict.absence = sample::without_roots(BandVerdict::proved).absence;
  const std::string levels = test::heading_levels(page(report));
  CHECK(std::count(levels.begin(), levels.end(), '1') == 1);
  CHECK(levels.starts_with("12"));
  for (std::size_t i = 1; i < levels.size(); ++i) CHECK(levels[i] <= levels[i - 1] + 1);
}

TEST_CASE("report: a part that is not there says why") {
  const std::string text = page(nothing_but(sample::hunting()));
  for (const char* why : {"<p>No sensitivity, for a reason.</p>", "<p>No map, &lt;for&gt; a reason.</p>",
                          "<p>No energy, for a reason.</p>", "<p>No precision, for a reason.</p>"})
    CHECK(holds(text, why));
  auto report = nothing_but(sample::hunting());
  report.predict.cycles.clear();
  report.predict.missed.clear();
  report.predict.nyquist = {};
  const std::string rests = page(report);
  CHECK(test::markup_fault(rests) == "");
  CHECK(holds(rests, "Without a limit cycle there are no harmonics and no Floquet multipliers"));
  CHECK(holds(rests, "there is no Nyquist plot"));
  CHECK_FALSE(holds(rests, "data-figure=\"harmonics\""));
}

TEST_CASE("report: interrupted, the page says so at its top") {
  auto report = nothing_but(sample::hunting());
  CHECK_FALSE(holds(page(report), "Interrupted"));
  report.interrupted = true;
  const std::string text = page(report);
  CHECK(text.find("Interrupted: this page shows the results computed so far") < text.find("<nav"));
}

TEST_CASE("report: self-contained, and nothing that a user wrote becomes markup") {
  auto report = nothing_but(sample::hunting());
  report.predict.outcomes[0].start = "</script><script>start()</script>";
  const std::string text = page(report);
  CHECK(holds(text, "default-src 'none'"));
  CHECK_FALSE(std::regex_search(text, std::regex("(src|href)\\s*=\\s*[\"'](?!data:|#)")));
  for (const char* part : {"<script>bad", "<script>start", "@import", "<servo>"}) CHECK_FALSE(holds(text, part));
  CHECK(holds(text, "<title>a &lt;servo&gt; - limcycle</title>"));
}

TEST_CASE("report: it holds its case, its flags and its result for programs") {
  const std::string text = page(nothing_but(sample::relay()), "a = \"ω</script>\"\r\n");
  const CaseInPage found = case_in_page(text);
  CHECK(found.text == "a = \"ω</script>\"\r\n");
  CHECK(found.command == "report");
  CHECK(found.flags == "--quick");
  const Json result = Json::parse(result_in_page(text));
  CHECK(result["schema"] == "limcycle/1");
  CHECK(result["cycles"].size() == 1);
  CHECK(holds(text, "limcycle report servo.toml --quick"));
}

TEST_CASE("report: the energy balance, as a sentence and a table") {
  auto report = nothing_but(sample::hunting());
  CountedRun counted{"the run of [simulate]", {}, {}};
  counted.run.trace.t = {0.0, 12.5};
  counted.energy.of_plant = true;
  counted.energy.command = 3.5;
  counted.energy.friction = 3.5;
  counted.energy.turnover = 3.5;
  counted.energy.allowed = 1e-6;
  report.energy.found = counted;
  const std::string text = page(report);
  CHECK(holds(text, "This is the run of [simulate], 12.5 s. The energy balances to 0 of 3.500 J turned over."));
  CHECK(holds(text, "<td class=\"left\">by the command</td><td>3.50000</td>"));
}

TEST_CASE("harmonics: amplitudes of the drawn cycle, and what is lost in the samples left out") {
  // y and force of the sample consist of pieces in closed form; y is half-wave symmetric.
  const auto figure = harmonics_figure(sample::hunting(), {});
  REQUIRE(figure);
  CHECK(figure->id == "harmonics");
  const Json data = Json::parse(figure->data);
  REQUIRE(data["order"].size() == 15);
  REQUIRE(data["curves"].size() == 2);
  CHECK(data["curves"][0]["name"] == "y (m)");
  CHECK(data["curves"][1]["name"] == "force (N)");
  const auto& y = data["curves"][0]["amplitude"];
  CHECK(y[1].is_null());  // even
  // At rest for a quarter, along half a cosine for a quarter, and the same on the other side.
  const double A = sample::hunting_cycle().amplitude;
  const auto exact = [&](int k) {
    return A * 16.0 / (std::numbers::pi * k) * std::abs(std::cos(k * std::numbers::pi / 4.0)) / std::abs(4.0 - k * k);
  };
  for (const int k : {1, 3, 5})
    CHECK(y[static_cast<std::size_t>(k - 1)].get<double>() == Approx(exact(k)).epsilon(1e-4));
  CHECK(holds(figure->finding, "the largest other is that of order 3"));
  auto report = sample::hunting();
  report.cycles.clear();
  CHECK_FALSE(harmonics_figure(report, {}));
  report = sample::hunting();
  for (std::size_t i = 0; i < report.cycles[0].trace.y.size(); ++i)
    report.cycles[0].trace.y[i] += report.cycles[0].trace.t[i];  // it keeps turning: y has no harmonics
  CHECK(Json::parse(harmonics_figure(report, {})->data)["curves"].size() == 1);
}
