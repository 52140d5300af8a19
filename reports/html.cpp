#include "limcycle/reports/html.hpp"

#include <fmt/format.h>

#include "limcycle/reports/answer.hpp"
#include "limcycle/reports/figures.hpp"
#include "limcycle/reports/html_parts.hpp"
#include "limcycle/reports/multipliers.hpp"
#include "limcycle/reports/number.hpp"
#include "limcycle/reports/page/page.hpp"
#include "limcycle/reports/plotly.hpp"
#include "limcycle/reports/text.hpp"

namespace limcycle {
namespace {

std::string trust_html(const PredictReport& report, const Units& units) {
  std::string out;
  if (const Table table = trust_table(report, units); !table.rows.empty())
    out += "<h2>Trust in the predictions</h2>\n" +
           html_table(table,
                      "Size of the harmonics that come back, share of the sinusoid that sticks, and where the "
                      "true cycles may lie");
  for (std::size_t i = 0; i < report.predictions.size(); ++i)
    if (const auto& trust = report.predictions[i].trust)
      out += html_tag("p", fmt::format("Prediction {}: {}. Its band: {}.", i, trust->sentence, trust->band.why));
  if (report.absence) out += "<h2>Absence of oscillations</h2>\n" + html_tag("p", absence_in_words(report));
  return out;
}

std::string tables(const PredictReport& report, const Units& units) {
  std::string out = "<h2>Limit cycles</h2>\n";
  out += report.cycles.empty() ? html_tag("p", "None was found.")
                               : html_table(cycle_table(report, units), "Limit cycles that exist, as best known");
  if (const Table table = multiplier_table(report); !table.rows.empty())
    out += html_table(table, "Floquet multipliers over the full period, without the trivial 1, largest first");
  out += "<h2>Predictions</h2>\n";
  Table predictions = prediction_table(report, units);
  predictions.columns.push_back({"why", "", Align::left});
  for (std::size_t i = 0; i < report.predictions.size(); ++i) predictions.rows[i].push_back(report.predictions[i].why);
  out += report.predictions.empty() ? html_tag("p", "None in the search box.")
                                    : html_table(predictions, "What each method predicts, with its verdict");
  for (const auto& missed : report.missed)
    out +=
        html_tag("p", fmt::format("Limit cycle {} is not seen by {}.", missed.cycle, method_in_words(missed.method)));
  out += trust_html(report, units);
  if (report.outcomes.empty()) return out;
  Table outcomes{{{"start", "", Align::left}, {"reaches", "", Align::left}, {"cycle", ""}, {"why", "", Align::left}},
                 {}};
  for (const auto& one : report.outcomes)
    outcomes.rows.push_back(
        {one.start, std::string(to_string(one.outcome)), one.cycle ? std::to_string(*one.cycle) : "-", one.why});
  return out + "<h2>Simulations</h2>\n" + html_table(outcomes, "What each start reaches");
}

}  // namespace

std::string predict_page(const PredictReport& report, const Provenance& provenance, const std::string& case_text,
                         const Units& units) {
  const CycleAnswer words = answer(report, units);
  const auto figures = predict_figures(report, units);
  std::string body = tables(report, units) + html_notes(report.notes);
  if (!figures.empty()) body += "<h2>Figures</h2>\n" + figures_html(figures);
  return html_page({.provenance = provenance,
                    .answer = words.what_happens,
                    .worth = words.worth,
                    .body = body,
                    .command = "predict",
                    .case_text = case_text,
                    .scripts = {std::string(plotly_script()), std::string(page_script())}});
}

}  // namespace limcycle
