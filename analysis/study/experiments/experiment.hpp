#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/status.hpp"
#include "limcycle/analysis/study/experiments/runs/laws.hpp"

namespace limcycle {

/// A column of numbers that an experiment measures.
struct Quantity {
  std::string key;      ///< "drift"
  std::string heading;  ///< "drift per cycle"
  std::string unit;     ///< empty: none
};

/// Results of one run of one law, in the order of the experiment's quantities; NaN if there is no such number.
struct Measured {
  std::string law;      ///< label of the setting
  std::string setting;  ///< what was varied, "0.1 N/s"; may be empty
  std::vector<double> values;
};

/// A sentence made from the numbers of one law.
struct Finding {
  std::string law;
  std::string text;
  Status status = Status::converged;
};

/// A curve of a figure. x and y are of equal length.
struct Curve {
  std::string name;
  std::vector<double> x, y;
};

/// One panel of a figure: usually for one law.
struct FigurePanel {
  std::string title;
  std::vector<Curve> curves;
};

struct ExperimentFigure {
  std::string id;       ///< "force-time"
  std::string heading;  ///< content of the figure, and the figure of the documents that it repeats
  std::string x, x_unit, y, y_unit;
  bool logarithmic = false;  ///< the x axis
  std::vector<FigurePanel> panels{};
};

/// Outcome of a statement of the documents.
enum class ClaimOutcome { confirmed, not_confirmed, depends, not_tested };

struct ExperimentClaim {
  std::string statement;  ///< in limcycle's words
  std::string source;     ///< "thesis, section 3.6.1"
  ClaimOutcome outcome = ClaimOutcome::not_tested;
  std::string measure;  ///< the measured difference
};

/// An experiment with its results: numbers, findings, claims and figures.
struct Experiment {
  std::string name, title;
  std::string document;  ///< figures of the documents that it repeats
  std::string input;     ///< the input signal, and which of its data were chosen here
  std::vector<Quantity> quantities;
  std::vector<Measured> rows;
  std::vector<Finding> findings;
  std::vector<ExperimentClaim> claims;
  std::vector<ExperimentFigure> figures;
  std::vector<std::string> notes;
  Status status = Status::converged;

  /// The number of a law at a setting; NaN if it was not measured.
  double value(const std::string& law, const std::string& key, const std::string& setting = {}) const;
};

/// Options of an experiment, with the laws that take part.
struct ExperimentOptions {
  std::vector<LawSetting> laws = law_settings();  ///< those not in the list of laws are omitted
  int threads = 1;                                ///< 0: one per core
  std::function<bool()> stop;                     ///< called by several threads
  std::function<void(double, std::string_view)> progress;
};

/// Entry of an experiment in the list.
struct ExperimentEntry {
  std::string_view name, title;
  Experiment (*run)(const ExperimentOptions&);
};

/// All experiments, in the order of the documents.
const std::vector<ExperimentEntry>& experiments();

std::string_view to_string(ClaimOutcome outcome);

}  // namespace limcycle
