#pragma once
#include <string>

#include "limcycle/analysis/study/adequacy/adequate.hpp"
#include "limcycle/reports/format/document.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/provenance.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// Simplest adequate model and the reason: one sentence, and one on the reference.
std::string adequate_answer(const AdequateReport& report, const Units& units);

/// One row a law, one column a method: error, or the verdict instead; then the worst over the spread.
Table ladder_table(const AdequateReport& report);

/// One row a law: the rule that gives its parameters.
Table rule_table(const AdequateReport& report);

/// One row a law and method: all measured quantities.
Table adequate_table(const AdequateReport& report, const Units& units);

std::string adequate_text(const std::string& title, const AdequateReport& report, const Units& units);
Document adequate_document(const std::string& title, const AdequateReport& report,
                           const Units& units);  ///< the same, with its tables

std::string adequate_json(const Provenance& provenance, const AdequateReport& report);

/// One row a law and method.
std::string adequate_csv(const AdequateReport& report);

std::string adequate_page(const AdequateReport& report, const Provenance& provenance, const std::string& case_text,
                          const Units& units);

}  // namespace limcycle
