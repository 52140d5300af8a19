#include <fmt/format.h>

#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/page/html_parts.hpp"
#include "limcycle/reports/remedy/costs.hpp"
#include "limcycle/reports/remedy/remedy.hpp"
#include "limcycle/reports/tune/tune.hpp"

namespace limcycle {

std::string tune_page(const TuneReport& report, const Provenance& provenance, const std::string& case_text,
                      const Units& units, const std::string& flags) {
  std::string body =
      "<h2>The search</h2>\n" +
      html_picture(tune_picture(report, units),
                   "Points that were tried, by outcome; those without hunting by their cost.", tune_csv(report)) +
      html_table(tune_number_table(report), "The numbers, and what a small change of each does");
  if (report.best) {
    body += "<h2>Before and after</h2>\n" +
            html_picture(response_picture({"as it stands", report.before}, {"tuned", report.after},
                                          report.costs.settling_time, units),
                         "Step response as it stands and tuned") +
            html_table(tune_cost_table(report, units), cost_legend(report.step, units));
  }
  if (!report.searches.empty())
    body +=
        "<h2>Local searches</h2>\n" + html_table(tune_search_table(report, units),
                                                 "Cost where each search begins and ends, and the numbers at its end");
  body += "<h2>Outcomes</h2>\n" + html_table(tune_outcome_table(report), "Points that were tried, by outcome");
  body += html_notes(report.notes);
  return html_page({.provenance = provenance,
                    .answer = tune_answer(report, units),
                    .body = body,
                    .command = "tune",
                    .flags = flags,
                    .case_text = case_text});
}

}  // namespace limcycle
