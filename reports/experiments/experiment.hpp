#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/status.hpp"
#include "limcycle/analysis/study/experiments/experiment.hpp"
#include "limcycle/reports/format/document.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/provenance.hpp"

namespace limcycle {

/// For a terminal: names and questions of all experiments.
std::string experiment_list(const std::vector<ExperimentEntry>& entries);
std::string experiment_list_json(const Provenance& provenance, const std::vector<ExperimentEntry>& entries);

/// For a terminal: the procedure, a finding for each law, the numbers (of a single experiment, up to
/// `longest_experiment_table` rows), the outcome of the documents' claims.
std::string experiment_text(const std::vector<Experiment>& experiments);
Document experiment_document(const std::vector<Experiment>& experiments);  ///< the same, with its tables
inline constexpr std::size_t longest_experiment_table = 100;

/// JSON document of `experiment`: numbers, findings, claims, and the curves as drawn. `ended`: status of the work.
std::string experiment_json(const Provenance& provenance, const std::vector<Experiment>& experiments,
                            Status ended = Status::converged);

/// One row a number, finding, claim and point of a curve, distinguished by the first column `kind`.
std::string experiment_csv(const std::vector<Experiment>& experiments);

/// Self-contained page without scripts.
std::string experiment_page(const std::vector<Experiment>& experiments, const Provenance& provenance,
                            const std::string& flags);

/// All figures as one SVG, each a row of small pictures, one for each law.
std::string experiment_picture(const std::vector<Experiment>& experiments);

/// One figure as an SVG.
std::string experiment_figure(const ExperimentFigure& figure);

/// The curves of a figure, one point a line: panel, curve, x, y.
std::string experiment_figure_csv(const ExperimentFigure& figure);

/// The numbers, one row a measurement.
Table experiment_table(const Experiment& one);

/// "13 of 18 claims confirmed, 3 not, 2 depend on the definition": in a sentence.
std::string claims_in_words(const std::vector<Experiment>& experiments);

}  // namespace limcycle
