#include "limcycle/reports/predict/predict_sections.hpp"

#include <fmt/format.h>

#include "limcycle/reports/figures/multipliers.hpp"
#include "limcycle/reports/page/html_parts.hpp"
#include "limcycle/reports/predict/verdict_text.hpp"
#include "limcycle/reports/text.hpp"

namespace limcycle {

std::string cycle_tables(const PredictReport& report, const Units& units) {
  if (report.cycles.empty()) return html_tag("p", "None was found.");
  std::string out = html_table(cycle_table(report, units), "Verified limit cycles");
  if (const Table table = multiplier_table(report); !table.rows.empty())
    out += html_table(table, "Floquet multipliers over the full period, without the trivial 1, largest first");
  return out;
}

std::string prediction_tables(const PredictReport& report, const Units& units) {
  Table predictions = prediction_table(report, units);
  predictions.columns.push_back({"why", "", Align::left});
  for (std::size_t i = 0; i < report.predictions.size(); ++i) predictions.rows[i].push_back(report.predictions[i].why);
  std::string out = report.predictions.empty() ? html_tag("p", "None in the search box.")
                                               : html_table(predictions, "Predictions and their verdicts");
  for (const auto& missed : report.missed)
    out +=
        html_tag("p", fmt::format("Limit cycle {} is not found by {}.", missed.cycle, method_in_words(missed.method)));
  return out;
}

std::string trust_sections(const PredictReport& report, const Units& units, int level) {
  const std::string heading = "h" + std::to_string(level);
  std::string out;
  if (const Table table = trust_table(report, units); !table.rows.empty())
    out += html_tag(heading, "Trust in the predictions") +
           html_table(table,
                      "Size of the returning harmonics, sticking share of the sinusoid, and bounds of the true cycles");
  for (std::size_t i = 0; i < report.predictions.size(); ++i)
    if (const auto& trust = report.predictions[i].trust)
      out += html_tag("p", fmt::format("Prediction {}: {}. Its band: {}.", i, trust->sentence, trust->band.why));
  if (report.absence) out += html_tag(heading, "Absence of oscillations") + html_tag("p", absence_in_words(report));
  return out;
}

std::string outcome_table(const PredictReport& report, const Units& units) {
  if (report.outcomes.empty()) return "";
  Table outcomes{{{"start", "", Align::left}, {"outcome", "", Align::left}, {"cycle", ""}, {"why", "", Align::left}},
                 {}};
  for (const auto& one : report.outcomes)
    outcomes.rows.push_back({start_in_words(one.start, units), std::string(to_string(one.outcome)),
                             one.cycle ? std::to_string(*one.cycle) : "-", one.why});
  return html_table(outcomes, "Outcome of each start");
}

}  // namespace limcycle
