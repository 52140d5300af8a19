#include "limcycle/reports/html.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>

#include "limcycle/reports/figures/drawing/plotly.hpp"
#include "limcycle/reports/figures/figures.hpp"
#include "limcycle/reports/page/html_parts.hpp"
#include "limcycle/reports/page/page.hpp"
#include "limcycle/tests/reports/sample_report.hpp"

using namespace limcycle;
using Json = nlohmann::json;

namespace {

Provenance hostile_provenance() {
  Provenance from;
  from.version = "1.2.3";
  from.title = "<script>alert('title')</script>";
  from.file = "a case's \"file\".toml";
  from.overrides = {"loop.plant.kind=\"mass\""};
  return from;
}

/// The page without the library, which may contain anything.
std::string page(const PredictReport& report, const std::string& case_text = "a = 1 # </pre><script>bad()</script>") {
  std::string text = predict_page(report, hostile_provenance(), case_text, {});
  const auto at = text.find(limcycle::plotly_script());
  REQUIRE(at != std::string::npos);
  return text.erase(at, plotly_script().size());
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

}  // namespace

TEST_CASE("escaping for HTML") {
  CHECK(html_escaped("a < b & c > \"d\" 'e'") == "a &lt; b &amp; c &gt; &quot;d&quot; &#39;e&#39;");
  CHECK(html_escaped("ω\n\x01") == "ω\n ");
  CHECK(html_escaped("\xC0\xAF\xED\xA0\x80") == "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD");
  CHECK(html_escaped("\xE6\x91") == "\xEF\xBF\xBD\xEF\xBF\xBD");
}

TEST_CASE("nothing that a user wrote becomes markup") {
  auto report = sample::hunting();
  report.outcomes[0].start = "</script><script>start()</script><!--";
  report.notes = {"<img src=x onerror=note()>"};
  const auto text = page(report);
  for (const char* part : {"<script>alert", "<script>bad", "<script>start", "<img src=x", "<!--"})
    CHECK_FALSE(holds(text, part));
  CHECK(holds(text, "&lt;script&gt;alert(&#39;title&#39;)&lt;/script&gt;"));
  // Five figures, the case, the result, the library, the script; the same number of closing tags.
  CHECK(count(text, "<script") == 9);
  CHECK(count(text, "</script>") == 9);
}

TEST_CASE("the page says the verdict, shows the tables and how to make it again") {
  const auto text = page(sample::relay());
  CHECK(holds(text, "This loop oscillates"));
  CHECK(holds(text, "<td class=\"left confirmed\">confirmed</td>"));
  CHECK(holds(text, "<td class=\"left false\">false</td>"));
  CHECK(holds(text, "a = 1 # &lt;/pre&gt;"));
  CHECK(holds(text, html_escaped("limcycle predict 'a case'\\''s \"file\".toml' --set 'loop.plant.kind=\"mass\"'")));
  CHECK(text.find("This loop oscillates") < text.find("<table"));
}

TEST_CASE("the page asks nothing of the network") {
  const auto text = page(sample::hunting());
  CHECK(holds(text, "default-src 'none'"));
  CHECK_FALSE(std::regex_search(text, std::regex("(src|href)\\s*=\\s*[\"'](?!data:|#)")));
  CHECK_FALSE(holds(text, "http://"));
  CHECK_FALSE(holds(text, "https://"));
  CHECK_FALSE(holds(text, "@import"));
}

TEST_CASE("a reader who uses keys skips to the results") {
  const auto text = page(sample::hunting());
  CHECK(text.find("<a class=\"skip\" href=\"#results\">") < text.find("<h1>"));
  CHECK(holds(text, "<main id=\"results\" tabindex=\"-1\">"));
}

TEST_CASE("a page without figures that are drawn by script has buttons all the same, and no library") {
  const auto text =
      html_page({.provenance = hostile_provenance(), .answer = "", .body = "", .command = "map", .case_text = ""});
  CHECK(holds(text, std::string(page_script())));
  CHECK_FALSE(holds(text, std::string(plotly_script())));
}

TEST_CASE("the style of a picture rules that picture only") {
  const std::string svg = "<svg width=\"1\"><style>text,.a b{fill:red}.c{x:1}</style><text/></svg>\n";
  const auto text = html_picture(svg, "What it <shows>");
  const auto at = text.find("<svg class=\"");
  REQUIRE(at != std::string::npos);
  const auto name = text.substr(at + 12, text.find('"', at + 12) - at - 12);
  CHECK(
      holds(text, "<style>." + name + " text,." + name + " .a b{fill:red}." + name + " .c{x:1}</style><text/></svg>"));
  CHECK(holds(text, "aria-label=\"Picture: What it &lt;shows&gt;\""));
  CHECK(holds(text, "<figcaption>What it &lt;shows&gt;</figcaption>"));
  const std::string other = "<svg width=\"1\"><style>text{fill:blue}</style></svg>";
  CHECK_FALSE(holds(html_picture(other, "x"), name));
  CHECK(html_picture("", "x").empty());
  CHECK(holds(html_picture("<svg><path/></svg>", "x"), "<svg><path/></svg>"));
  CHECK_FALSE(holds(html_picture("<svg><text>a &lt; b</text></svg>", "a < b"), "<figcaption>"));
  CHECK(holds(html_picture("<svg/>", "x", "a\n</script>\n"), "class=\"rows\">\"a\\n\\u003c/script>\\n\"</script>"));
  CHECK_FALSE(holds(html_picture("<svg/>", "x", std::string(600000, 'a')), "rows"));
}

TEST_CASE("each figure says in words what it shows") {
  const auto figures = predict_figures(sample::hunting(), {});
  REQUIRE(figures.size() == 5);
  const auto text = page(sample::hunting());
  for (const auto& figure : figures) {
    CHECK(figure.finding.size() > 40);
    CHECK(holds(text, "<figcaption>" + html_escaped(figure.finding)));
    CHECK(holds(text, "data-figure=\"" + figure.id + "\" tabindex=\"0\" role=\"img\" aria-label=\""));
    CHECK(holds(std::string(page_script()), "\n  " + figure.id + "(d) {"));
  }
  CHECK(holds(figures[1].finding, "y moves between -0.0639 and 0.0639 m"));
  CHECK(holds(figures[1].finding, "it sticks for 50 % of the time"));
}

TEST_CASE("Floquet multipliers: a table, and a figure that says the size of the largest") {
  const auto figures = predict_figures(sample::hunting(), {});
  CHECK(figures.back().id == "multipliers");
  CHECK(holds(figures.back().finding, "Modulus of the largest: 0.00955 of limit cycle 0."));
  CHECK(Json::parse(figures.back().data) ==
        Json({{"cycles", {{{"name", "limit cycle 0"}, {"re", {0.0095, 0.0}}, {"im", {-0.001, 0.0}}}}}}));
  CHECK(holds(page(sample::hunting()), ">0.00950 - 0.00100j, 1 below 1e-06</td>"));
  auto report = sample::hunting();
  report.cycles[0].multipliers.clear();
  CHECK(predict_figures(report, {}).size() == 4);
  report.cycles[0].multipliers = {{std::numeric_limits<double>::quiet_NaN(), 0.0}};
  CHECK(Json::parse(predict_figures(report, {}).back().data)["cycles"][0]["re"][0].is_null());
}

TEST_CASE("figures hold JSON without what would end their element, and few points") {
  auto report = sample::hunting();
  report.outcomes[0].trace = sample::stick_slip_trace(1.0, 24.0, 50001);
  report.outcomes[0].start = "</script>";
  report.nyquist.G[1] = {std::numeric_limits<double>::quiet_NaN(), 0.0};
  for (const auto& figure : predict_figures(report, {})) {
    CHECK(figure.data.find('<') == std::string::npos);
    const auto data = Json::parse(figure.data);
    if (figure.id == "nyquist") CHECK(data["G"]["re"][1].is_null());
    if (figure.id != "phase") continue;
    CHECK(data["runs"][0]["name"] == "from </script>");
    for (const auto& run : data["runs"]) {
      CHECK(run["y"].size() <= 2000);
      CHECK(run["y"].size() >= 500);
    }
    const auto& stuck = data["cycles"][0]["stuck"];
    CHECK(std::count(stuck.begin(), stuck.end(), 1) > 10);
  }
}

TEST_CASE("trust: a table with reasons, the discs drawn by kind and named in words, absence in a sentence") {
  const auto text = page(sample::trusted());
  CHECK(holds(text, "<h2>Trust in the predictions</h2>"));
  CHECK(holds(text, "a cycle within 6 % of it is proved"));
  CHECK(holds(text, "no bounded band"));
  CHECK_FALSE(holds(text, "<h2>Absence of oscillations</h2>"));
  auto report = sample::trusted();
  report.predictions[1].trust->band.discs = {{7.0, {-0.1, 0.0}, 0.02}};
  const auto figures = predict_figures(report, {});
  REQUIRE(figures[0].id == "nyquist");
  CHECK(holds(figures[0].finding,
              "Rigorous error discs (Mees-Bergen, solid circles) are drawn over the band 0.9800 to "
              "1.030 rad/s in which a cycle is proved."));
  CHECK(holds(figures[0].finding, "The error disc (dashed) at 7.00 rad/s is heuristic."));
  const auto discs = Json::parse(figures[0].data)["discs"];
  REQUIRE(discs.size() == 3);
  CHECK(discs[0] == Json({{"kind", "rigorous"}, {"re", -0.8}, {"im", 0.1}, {"r", 0.05}, {"w", 0.98}}));
  CHECK(discs[2]["kind"] == "heuristic");
  const std::string script(page_script());
  CHECK(holds(script, "[\"rigorous\", \"error discs (Mees–Bergen, rigorous)\", \"solid\"]"));
  CHECK(holds(script, "[\"heuristic\", \"error discs (heuristic)\", \"dash\"]"));
  CHECK(Json::parse(predict_figures(sample::relay(), {})[0].data)["discs"].empty());
  const auto proved = page(sample::without_roots(BandVerdict::proved));
  CHECK(holds(proved, "<h2>Absence of oscillations</h2>\n<p>Proved (Mees and Bergen 1975): "));
}

TEST_CASE("a report without traces or curves has no figures but is a page") {
  auto report = sample::hunting();
  report.nyquist = {};
  report.cycles[0].trace = {};
  report.outcomes.clear();
  CHECK(predict_figures(report, {}).empty());
  const auto text = page(report, "");
  CHECK_FALSE(holds(text, "<figure>"));
  CHECK_FALSE(holds(text, "<details"));
  CHECK(holds(text, "This loop hunts"));
}

TEST_CASE("a period that is too long to draw well is drawn whole all the same: it is shown twice") {
  auto report = sample::hunting();
  auto& trace = report.cycles[0].trace;
  for (std::size_t i = 0; i < trace.t.size(); ++i) {
    trace.rate[i] = std::sin(400.0 * trace.t[i]);
    trace.y[i] = std::cos(400.0 * trace.t[i]);
  }
  for (const auto& figure : predict_figures(report, {})) {
    const auto data = Json::parse(figure.data);
    if (figure.id == "time") CHECK(data["run"]["t"].back().get<double>() == Approx(trace.t.back()));
    if (figure.id == "phase") CHECK(data["cycles"][0]["t"].back().get<double>() == Approx(trace.t.back()));
  }
}
