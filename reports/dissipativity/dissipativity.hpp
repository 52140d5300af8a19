#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/dissipativity.hpp"
#include "limcycle/analysis/study/experiments/experiment.hpp"
#include "limcycle/reports/format/document.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/provenance.hpp"

namespace limcycle {

/// Passivity and its consequences: one to three sentences.
std::string dissipativity_answer(const DissipativityReport& report);

/// For a terminal: the answer, bounds, passivity with the counter-example, and conclusions from energy for the loop.
std::string dissipativity_text(const std::string& title, const DissipativityReport& report);
Document dissipativity_document(const std::string& title,
                                const DissipativityReport& report);  ///< the same, with its tables

std::string dissipativity_json(const Provenance& provenance, const DissipativityReport& report);

/// The storage over the state and the counter-example, one row a point, distinguished by the first column `kind`.
std::string dissipativity_csv(const DissipativityReport& report);

std::string dissipativity_page(const DissipativityReport& report, const Provenance& provenance,
                               const std::string& case_text, const std::string& flags);

/// Markup of the results, under headings of this level (2: h2).
std::string dissipativity_sections(const DissipativityReport& report, int level);

/// Bounds of the states and of the force, with their evidence.
Table bound_table(const DissipativityReport& report);

/// Questions about the loop: answer and reason.
Table loop_table(const DissipativityReport& report);

/// One line each: name of the number, its value with unit, its meaning.
std::vector<std::vector<std::string>> passivity_facts(const DissipativityReport& report);

/// The velocity of the counter-example, piece by piece.
Table counterexample_table(const Counterexample& found);

/// Storage, counter-example and resistance of the rest of the loop, as far as available.
std::vector<ExperimentFigure> dissipativity_figures(const DissipativityReport& report);

}  // namespace limcycle
