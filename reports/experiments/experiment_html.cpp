#include <fmt/format.h>

#include <algorithm>

#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/experiments/experiment.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/page/html_parts.hpp"

namespace limcycle {
namespace {

std::string claims_html(const Experiment& one) {
  if (one.claims.empty()) return "";
  Table table{{{"verdict", "", Align::left},
               {"claim", "", Align::left},
               {"source", "", Align::left},
               {"measured", "", Align::left}},
              {}};
  for (const auto& claim : one.claims)
    table.rows.push_back({std::string(to_string(claim.outcome)), claim.statement, claim.source,
                          claim.measure.empty() ? "-" : claim.measure});
  return html_table(table, "Claims of the documents");
}

std::string findings_html(const Experiment& one) {
  if (one.findings.empty()) return "";
  Table table{{{"law", "", Align::left}, {"finding", "", Align::left}}, {}};
  for (const auto& finding : one.findings) table.rows.push_back({finding.law, finding.text});
  return html_table(table, "Findings by law");
}

std::string one_html(const Experiment& one, bool several) {
  std::string out;
  if (several)
    out = "<h2 id=\"" + html_escaped(one.name) + "\">" + html_escaped(one.name + ": " + one.title) + "</h2>\n";
  out += html_tag("p", "After: " + one.document + ".") + html_tag("p", "Input: " + one.input + ".");
  out += findings_html(one) + claims_html(one);
  for (const auto& figure : one.figures) {
    if (figure.panels.empty()) continue;
    out += html_picture(experiment_figure(figure), figure.heading, experiment_figure_csv(figure));
  }
  if (!one.rows.empty())
    out += "<details><summary>Numbers</summary>\n" + html_table(experiment_table(one), "Numbers of " + one.name) +
           "</details>\n";
  return out + html_notes(one.notes);
}

}  // namespace

std::string experiment_figure_csv(const ExperimentFigure& figure) {
  const auto with_unit = [](const std::string& name, const std::string& unit) {
    return unit.empty() ? name : name + " (" + unit + ")";
  };
  std::string out =
      csv_line({"panel", "curve", with_unit(figure.x, figure.x_unit), with_unit(figure.y, figure.y_unit)});
  for (const auto& panel : figure.panels)
    for (const auto& curve : panel.curves)
      for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i)
        out += csv_line({panel.title, curve.name, shortest(curve.x[i]), shortest(curve.y[i])});
  return out;
}

std::string experiment_page(const std::vector<Experiment>& experiments, const Provenance& provenance,
                            const std::string& flags) {
  Provenance named = provenance;
  const bool several = experiments.size() != 1;
  named.title = several ? "Experiments with friction laws" : experiments.front().title;
  std::string body, list, name = several ? "all" : experiments.front().name;
  for (const auto& one : experiments) {
    body += one_html(one, several);
    list +=
        "<li><a href=\"#" + html_escaped(one.name) + "\">" + html_escaped(one.name + ": " + one.title) + "</a></li>\n";
  }
  if (several) body = "<ul>\n" + list + "</ul>\n" + body;
  std::string answer = claims_in_words(experiments);
  if (answer.empty() && !several) answer = experiments.front().document;
  return html_page({.provenance = named,
                    .answer = answer,
                    .body = body,
                    .command = "experiment " + name,
                    .flags = flags,
                    .case_text = ""});
}

}  // namespace limcycle
