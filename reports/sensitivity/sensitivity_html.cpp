#include <fmt/format.h>

#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/page/html_parts.hpp"
#include "limcycle/reports/sensitivity/sensitivity.hpp"

namespace limcycle {
namespace {

std::string output_section(const SensitivityReport& report, const OutputSensitivity& output,
                           const std::string& heading) {
  const bool correlated = output.sobol.parameters.empty();
  if (correlated && output.share_without_answer == 0.0) return "";
  std::string out = html_tag(heading, "Global: " + output.output);
  out += html_tag("p", fmt::format("No answer from {} of the loops.", as_percent(output.share_without_answer)));
  if (correlated) return out;
  if (output.sobol.deviation == 0.0)
    return out + html_tag("p", "It is the same for every loop that answered: there is no variance to share out.");
  out += html_picture(indices_picture(report, output),
                      "Shares of the variance with 95 % intervals; beside them how the total indices settled.");
  out += html_picture(
      interactions_picture(report, output),
      "Share of each number alone (diagonal) and of each pair. Faint values are not distinguishable from 0.");
  out += html_table(sobol_table(report, output), "Sobol indices of " + output.output);
  out += html_table(morris_table(report, output), "Morris: effects on " + output.output + " of each whole range");
  std::vector<std::string> notes = output.sobol.notes;
  notes.insert(notes.end(), output.morris.notes.begin(), output.morris.notes.end());
  return out + html_notes(notes, heading.back() - '0');
}

std::string prediction_sections(const SensitivityReport& report, const Units& units, const std::string& heading) {
  std::string body;
  for (std::size_t k = 0; k < report.predicted.size(); ++k) {
    const auto& predicted = report.predicted[k];
    body += html_tag(heading, predicted_heading(report, k)) + html_tag("p", predicted_sentence(predicted, units));
    if (const Table table = predicted_table(predicted, units); !table.rows.empty())
      body += html_table(table, "Exact derivatives of the predicted oscillation");
    if (const Table table = gain_table(predicted, units); !table.rows.empty())
      body += html_table(table, "Exact derivatives of the describing function, at this amplitude and frequency");
  }
  return body;
}

std::string threshold_section(const ThresholdSensitivity& threshold, const std::string& heading) {
  std::string body = html_tag(heading, "Threshold of " + threshold.path) +
                     html_tag("p", threshold_sentence(threshold)) +
                     html_picture(threshold_picture(threshold), "Change of the threshold for +1 % of a number.");
  if (const Table table = threshold_table(threshold); !table.rows.empty())
    body += html_table(table, "Exact derivatives of the threshold");
  return body;
}

}  // namespace

std::string sensitivity_sections(const SensitivityReport& report, const Units& units, int level) {
  const std::string heading = "h" + std::to_string(level);
  std::string body;
  if (report.cycle && !report.local.empty()) {
    body += html_tag(heading, "The cycle") +
            html_picture(tornado_picture(report), "Change of amplitude and period for +1 % of a number.");
    body += html_table(derivative_table(report, units), "Exact derivatives of amplitude and period");
    body += html_table(harmonic_table(report, units), "Exact derivatives of first harmonic and offset");
  }
  body += prediction_sections(report, units, heading);
  for (const auto& threshold : report.thresholds) body += threshold_section(threshold, heading);
  if (!report.one_at_a_time.empty())
    body +=
        html_tag(heading, "One at a time") + html_table(change_table(report, units), "Outcome with one number changed");
  if (report.global) {
    body += html_tag(heading, "The spread") +
            html_picture(hunting_heat_picture(report), "Values of the spread at which the loop hunts.") +
            html_picture(scatter_picture(report), "Every loop of the fair sample over each of the parameters.");
    if (const Table bands = band_table(report, units); !bands.rows.empty())
      body += html_table(bands, "Where it hunts, 95 % of the loops lie between low and high");
    for (const auto& output : report.global->outputs) body += output_section(report, output, heading);
  }
  return body + html_notes(sensitivity_notes(report), level);
}

std::string sensitivity_page(const SensitivityReport& report, const Provenance& provenance,
                             const std::string& case_text, const Units& units, const std::string& flags) {
  return html_page({.provenance = provenance,
                    .answer = sensitivity_answer(report),
                    .body = sensitivity_sections(report, units, 2),
                    .command = "sensitivity",
                    .flags = flags,
                    .case_text = case_text});
}

}  // namespace limcycle
