#include <fmt/format.h>

#include "limcycle/reports/continue.hpp"
#include "limcycle/reports/html.hpp"
#include "limcycle/reports/number.hpp"
#include "limcycle/reports/study_page.hpp"

namespace limcycle {

std::string continue_page(const ContinueReport& report, const Provenance& provenance, const std::string& case_text,
                          const Units& units) {
  std::string body;
  if (!report.found.branches.empty()) {
    body += "<h2>Bifurcation diagram</h2>\n<figure class=\"scroll\">\n" + continue_picture(report, units) +
            "<figcaption>Amplitude and period of every limit cycle that was followed, over " +
            html_escaped(report.path) + "; stable parts solid, unstable ones dashed.</figcaption>\n</figure>\n";
    Table table = event_table(report, units);
    table.columns.push_back({"what happens", "", Align::left});
    std::size_t row = 0;
    for (const auto& branch : report.found.branches)
      for (const auto& event : branch.events) table.rows[row++].push_back(event.why);
    body += "<h2>Events</h2>\n" + static_table(table, "Folds, changes of stability and ends of the branches");
  }
  if (!report.found.notes.empty()) {
    body += "<h2>Notes</h2>\n<ul>\n";
    for (const auto& note : report.found.notes) body += "<li>" + html_escaped(note) + "</li>\n";
    body += "</ul>\n";
  }
  const std::string command = fmt::format("continue {} --parameter {}={}:{}", provenance.file, report.path,
                                          shortest(report.found.from), shortest(report.found.to));
  return static_page(provenance, continue_answer(report, units), body, command, case_text);
}

}  // namespace limcycle
