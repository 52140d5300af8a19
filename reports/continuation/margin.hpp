#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/continuation/margin.hpp"
#include "limcycle/reports/format/document.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/provenance.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// One sentence that answers "what must I change?", and one on the describing function.
std::string margin_answer(const MarginReport& report, const Units& units);

/// For a terminal: the answer, a table of plant and controller, one of friction, the sentences on their details.
std::string margin_text(const std::string& title, const MarginReport& report, const Units& units);
Document margin_document(const std::string& title, const MarginReport& report,
                         const Units& units);  ///< the same, with its tables

std::string margin_json(const Provenance& provenance, const MarginReport& report);

/// One row a side of a parameter.
std::string margin_csv(const MarginReport& report);

/// The tables of a page, with the sentences on their details, under headings of this level.
std::string margin_sections(const MarginReport& report, int level);

std::string margin_page(const MarginReport& report, const Provenance& provenance, const std::string& case_text,
                        const Units& units);

/// Parameters of the friction law, or of plant and controller.
Table margin_table(const MarginReport& report, bool friction);
/// A sentence on each of their sides where something happens or is not known.
std::vector<std::string> margin_reasons(const MarginReport& report, bool friction);

}  // namespace limcycle
