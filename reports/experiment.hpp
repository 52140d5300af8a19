#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/status.hpp"
#include "limcycle/analysis/study/experiments/experiment.hpp"
#include "limcycle/reports/provenance.hpp"
#include "limcycle/reports/table.hpp"

namespace limcycle {

/// For a terminal: names and questions of all experiments.
std::string experiment_list(const std::vector<ExperimentEntry>& entries);
std::string experiment_list_json(const Provenance& provenance, const std::vector<ExperimentEntry>& entries);

/// For a terminal: what was done, a finding for each law, the numbers (of a single experiment, up to
/// `longest_experiment_table` rows), what became of the documents' claims.
std::string experiment_text(const std::vector<Experiment>& experiments);
inline constexpr std::size_t longest_experiment_table = 100;

/// JSON document of `experiment`: numbers, findings, claims, and the curves of the figures as they are drawn. `ended`:
/// how the work did.
std::string experiment_json(const Provenance& provenance, const std::vector<Experiment>& experiments,
                            Status ended = Status::converged);

/// One row a number, finding, claim and point of a curve, told apart by the first column `kind`.
std::string experiment_csv(const std::vector<Experiment>& experiments);

/// Self-contained page without scripts.
std::string experiment_page(const std::vector<Experiment>& experiments, const Provenance& provenance,
                            const std::string& flags);

/// All figures as one SVG, each of them small pictures side by side, one for each law.
std::string experiment_picture(const std::vector<Experiment>& experiments);

/// One figure as an SVG.
std::string experiment_figure(const ExperimentFigure& figure);

/// Its curves, one point a line: panel, curve, x, y.
std::string experiment_figure_csv(const ExperimentFigure& figure);

/// The numbers, one row a measurement.
Table experiment_table(const Experiment& one);

/// "13 of 18 claims confirmed, 3 not, 2 depend on the definition": in a sentence.
std::string claims_in_words(const std::vector<Experiment>& experiments);

}  // namespace limcycle
