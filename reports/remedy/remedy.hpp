#pragma once
#include <string>

#include "limcycle/analysis/study/remedy/remedy.hpp"
#include "limcycle/reports/format/document.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/provenance.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// Why the loop hunts and the first remedy of the list, in two sentences. The report stays in the units of the case
/// here and below; y is converted while it is printed.
std::string remedy_answer(const RemedyReport& report, const Units& units);

/// For a terminal: the answer, the remedies that end hunting with their costs, the others with the reason.
std::string remedy_text(const std::string& title, const RemedyReport& report, const Units& units);
Document remedy_document(const std::string& title, const RemedyReport& report,
                         const Units& units);  ///< the same, with its tables

std::string remedy_json(const Provenance& provenance, const RemedyReport& report);

/// One row a remedy.
std::string remedy_csv(const RemedyReport& report);

/// The tables of a page and the step responses before and after each remedy, under headings of this level.
std::string remedy_sections(const RemedyReport& report, const Units& units, int level);

/// The same as the text, with the step response before and after each remedy, side by side on the same axes.
std::string remedy_page(const RemedyReport& report, const Provenance& provenance, const std::string& case_text,
                        const Units& units);

/// The step response of the loop as it stands and with one remedy, two panels with the same axes, as SVG.
std::string remedy_picture(const RemedyReport& report, const Remedy& remedy, const Units& units);

/// Two step responses, two panels with the same axes, as SVG; until the second one has settled, if `settled` (s) says
/// when, at most to the end of the longer one. Empty if either is.
struct Response {
  std::string name;
  const Trace& run;
};
std::string response_picture(const Response& before, const Response& after, const std::optional<double>& settled,
                             const Units& units);

/// Remedies that end hunting: their numbers, and their costs.
Table remedy_table(const RemedyReport& report, const Units& units);
Table remedy_cost_table(const RemedyReport& report, const Units& units);

}  // namespace limcycle
