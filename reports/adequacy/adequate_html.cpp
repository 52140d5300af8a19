#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/adequacy/adequate.hpp"
#include "limcycle/reports/figures/drawing/plotly.hpp"
#include "limcycle/reports/figures/work_figures.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/page/html_parts.hpp"
#include "limcycle/reports/page/page.hpp"
#include "limcycle/reports/precision/precision.hpp"

namespace limcycle {
namespace {

constexpr double least_drawn = 1e-8;  ///< errors of zero cannot be shown on a logarithmic axis

/// One series a law, one mark a method; a result outside the tolerance is a cross.
Figure ladder_figure(const AdequateReport& report) {
  std::vector<WorkSeries> series;
  for (const auto& law : report.laws) {
    WorkSeries one{.name = law.name, .marks = {}, .joined = false};
    for (const auto& point : report.points) {
      if (point.law != law.name) continue;
      const std::string says = point.within ? "enough" : point.why;
      const double error = std::isfinite(point.error) ? std::max(point.error, least_drawn) : not_known;
      one.marks.push_back(
          {point.answer.seconds, error, point.within,
           fmt::format("{}, {}: {}, {}", point.law, point.method, as_duration(point.answer.seconds), says)});
    }
    if (!one.marks.empty()) series.push_back(std::move(one));
  }
  return work_figure(
      "work-ladder", "Laws and methods: error against cost",
      fmt::format("Circles stay within {}; crosses do not, and stand at the upper edge where the verdict "
                  "is another or there is no answer. Errors below {} are drawn there.",
                  as_percent(report.tolerance), as_error(least_drawn)),
      "CPU time (s)", "relative error of period and amplitude", series);
}

}  // namespace

std::string adequate_page(const AdequateReport& report, const Provenance& provenance, const std::string& case_text,
                          const Units& units) {
  std::string body;
  if (!report.points.empty()) {
    body += "<h2>The ladder</h2>\n" +
            html_table(ladder_table(report), "Error of period and amplitude by law and method, or the other verdict") +
            figures_html({ladder_figure(report)}) + "<details><summary>All answers</summary>\n" +
            html_table(adequate_table(report, units), "Results by law and method") + "</details>\n";
  }
  body += "<h2>Rules</h2>\n" + html_table(rule_table(report), "Parameters of each law");
  if (!report.spread.empty()) {
    std::string spread = "Spread: " + report.spread_rule + ": ";
    for (const auto& one : report.spread) spread += (&one == report.spread.data() ? "" : "; ") + one;
    body += html_tag("p", spread + ".");
  }
  body += html_notes(report.notes);
  return html_page({.provenance = provenance,
                    .answer = adequate_answer(report, units),
                    .body = body,
                    .command = "adequate",
                    .flags = fmt::format("--tolerance {}", shortest(report.tolerance)),
                    .case_text = case_text,
                    .scripts = {std::string(plotly_script()), std::string(page_script())}});
}

}  // namespace limcycle
