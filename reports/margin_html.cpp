#include <fmt/format.h>

#include "limcycle/reports/html.hpp"
#include "limcycle/reports/margin.hpp"
#include "limcycle/reports/study_page.hpp"

namespace limcycle {

std::string margin_page(const MarginReport& report, const Provenance& provenance, const std::string& case_text,
                        const Units& units) {
  std::string body;
  for (const bool friction : {false, true}) {
    Table table = margin_table(report, friction);
    if (table.rows.empty()) continue;
    table.columns.push_back({"above: why", "", Align::left});
    table.columns.push_back({"below: why", "", Align::left});
    std::size_t row = 0;
    for (const auto& one : report.parameters) {
      if (one.parameter.friction != friction) continue;
      table.rows[row].push_back(one.up.why);
      table.rows[row++].push_back(one.down.why);
    }
    const std::string heading = friction ? "Friction" : "Plant and controller";
    body += "<h2>" + heading + "</h2>\n" +
            static_table(table, heading + ": where hunting " + (report.hunts ? "ends" : "begins"));
  }
  if (!report.notes.empty()) {
    body += "<h2>Notes</h2>\n<ul>\n";
    for (const auto& note : report.notes) body += "<li>" + html_escaped(note) + "</li>\n";
    body += "</ul>\n";
  }
  return static_page(provenance, margin_answer(report, units), body, "margin " + provenance.file, case_text);
}

}  // namespace limcycle
