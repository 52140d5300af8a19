#include <fmt/format.h>

#include "limcycle/reports/continuation/continue.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/page/html_parts.hpp"

namespace limcycle {

std::string continue_page(const ContinueReport& report, const Provenance& provenance, const std::string& case_text,
                          const Units& units) {
  std::string body;
  if (!report.found.branches.empty()) {
    body += "<h2>Bifurcation diagram</h2>\n" +
            html_picture(continue_picture(report, units),
                         "Amplitude and period of every limit cycle that was followed, over " + report.path +
                             "; stable parts solid, unstable ones dashed.",
                         continue_csv(report));
    Table table = event_table(report, units);
    table.columns.push_back({"event", "", Align::left});
    std::size_t row = 0;
    for (const auto& branch : report.found.branches)
      for (const auto& event : branch.events) table.rows[row++].push_back(event.why);
    body += "<h2>Events</h2>\n" + html_table(table, "Folds, changes of stability and ends of the branches");
  }
  body += html_notes(report.found.notes);
  return html_page({.provenance = provenance,
                    .answer = continue_answer(report, units),
                    .body = body,
                    .command = "continue",
                    .flags = fmt::format("--parameter {}={}:{}", report.path, shortest(report.found.from),
                                         shortest(report.found.to)),
                    .case_text = case_text});
}

}  // namespace limcycle
