#include <fmt/format.h>

#include "limcycle/reports/continuation/margin.hpp"
#include "limcycle/reports/page/html_parts.hpp"

namespace limcycle {

std::string margin_sections(const MarginReport& report, int level) {
  std::string body;
  for (const bool friction : {false, true}) {
    const Table table = margin_table(report, friction);
    if (table.rows.empty()) continue;
    const std::string heading = friction ? "Friction" : "Plant and controller";
    body += html_tag(fmt::format("h{}", level), heading) +
            html_table(table, heading + ": where hunting " + (report.hunts ? "ends" : "begins"));
    std::string reasons;
    for (const auto& sentence : margin_reasons(report, friction)) reasons += html_tag("li", sentence);
    if (!reasons.empty()) body += "<ul>\n" + reasons + "</ul>\n";
  }
  return body;
}

std::string margin_page(const MarginReport& report, const Provenance& provenance, const std::string& case_text,
                        const Units& units) {
  return html_page({.provenance = provenance,
                    .answer = margin_answer(report, units),
                    .body = margin_sections(report, 2) + html_notes(report.notes),
                    .command = "margin",
                    .case_text = case_text});
}

}  // namespace limcycle
