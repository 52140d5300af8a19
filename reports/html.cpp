#include "limcycle/reports/html.hpp"

#include "limcycle/reports/figures/drawing/plotly.hpp"
#include "limcycle/reports/figures/figures.hpp"
#include "limcycle/reports/in_units.hpp"
#include "limcycle/reports/json.hpp"
#include "limcycle/reports/page/html_parts.hpp"
#include "limcycle/reports/page/page.hpp"
#include "limcycle/reports/predict/predict_sections.hpp"
#include "limcycle/reports/predict/verdict_text.hpp"

namespace limcycle {
namespace {

std::string tables(const PredictReport& report, const Units& units) {
  std::string out = "<h2>Limit cycles</h2>\n" + cycle_tables(report, units) + "<h2>Predictions</h2>\n" +
                    prediction_tables(report, units) + trust_sections(report, units, 2);
  const std::string outcomes = outcome_table(report, units);
  return outcomes.empty() ? out : out + "<h2>Simulations</h2>\n" + outcomes;
}

}  // namespace

std::string predict_page(const PredictReport& report, const Provenance& provenance, const std::string& case_text,
                         const Units& units) {
  const VerdictText words = answer(report, units);
  const auto figures = predict_figures(report, units);
  std::string body = tables(report, units) + html_notes(report.notes);
  if (!figures.empty()) body += "<h2>Figures</h2>\n" + figures_html(figures);
  return html_page({.provenance = provenance,
                    .answer = words.what_happens,
                    .worth = words.worth,
                    .body = body,
                    .command = "predict",
                    .case_text = case_text,
                    .result = predict_json(provenance, in_units(report, in_si(units))),
                    .scripts = {std::string(plotly_script()), std::string(page_script())}});
}

}  // namespace limcycle
