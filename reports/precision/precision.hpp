#pragma once
#include <string>

#include "limcycle/analysis/study/precision/precision.hpp"
#include "limcycle/reports/figures/figures.hpp"
#include "limcycle/reports/format/document.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/provenance.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// "2.4 ms", "13 us", "1.2 s".
std::string as_duration(double seconds);

/// Best method for each error, and methods that are never best: sentences. Empty for a chart without points.
std::string front_in_words(const WorkChart& chart);

/// The reference and its reliability, in one sentence.
std::string reference_in_words(const WorkChart& chart);

/// Starting conditions of the methods for the cycle.
std::string conditions();

/// One sentence that answers "which method shall I use?", for each question.
std::string precision_answer(const PrecisionReport& report);

/// One row a method: its cost at some errors, the least error it reaches, and how often it failed.
Table method_table(const WorkChart& chart);

/// One row a setting: everything measured.
Table point_table(const WorkChart& chart);

/// One row a stiffness and tolerance, one column a stepper: its time if it is right, else its class.
Table stiffness_table(const StiffnessStudy& study);

std::string precision_text(const std::string& title, const PrecisionReport& report, const Units& units);
Document precision_document(const std::string& title, const PrecisionReport& report,
                            const Units& units);  ///< the same, with its tables

std::string precision_json(const Provenance& provenance, const PrecisionReport& report);

/// One row a point of a chart or of the stiffness study, distinguished by the first column.
std::string precision_csv(const PrecisionReport& report);

/// Markup of charts and tables, under headings of this level (2: h2); the figures need the page's scripts.
std::string precision_sections(const PrecisionReport& report, const Units& units, int level);

std::string precision_page(const PrecisionReport& report, const Provenance& provenance, const std::string& case_text,
                           const Units& units);

}  // namespace limcycle
