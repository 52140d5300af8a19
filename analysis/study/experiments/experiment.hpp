#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/status.hpp"
#include "limcycle/analysis/study/experiments/laws.hpp"

namespace limcycle {

/// A column of numbers that an experiment measures.
struct Quantity {
  std::string key;      ///< "drift"
  std::string heading;  ///< "drift per cycle"
  std::string unit;     ///< empty: none
};

/// What one run of one law measured, in the order of the experiment's quantities; NaN where there is no such number.
struct Measured {
  std::string law;      ///< label of the setting
  std::string setting;  ///< what was varied, "0.1 N/s"; may be empty
  std::vector<double> values;
};

/// What the numbers of one law say, in a sentence made of them.
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

/// One picture among several of a figure: those of one law, as a rule.
struct FigurePanel {
  std::string title;
  std::vector<Curve> curves;
};

struct ExperimentFigure {
  std::string id;       ///< "force-time"
  std::string heading;  ///< what is drawn, and which figure of the documents it stands for
  std::string x, x_unit, y, y_unit;
  bool logarithmic = false;  ///< the x axis
  std::vector<FigurePanel> panels{};
};

/// What became of a statement of the documents.
enum class ClaimOutcome { confirmed, not_confirmed, depends, not_tested };

struct ExperimentClaim {
  std::string statement;  ///< in our words
  std::string source;     ///< "thesis, section 3.6.1"
  ClaimOutcome outcome = ClaimOutcome::not_tested;
  std::string measure;  ///< by how much
};

/// An experiment that was done: numbers, findings, claims and figures.
struct Experiment {
  std::string name, title;
  std::string document;  ///< which figures of the documents it repeats
  std::string input;     ///< the input signal, and what of it was chosen here
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

/// Which laws take part in an experiment.
struct ExperimentOptions {
  std::vector<LawSetting> laws = law_settings();  ///< those not in the list of laws are left out
  int threads = 1;                                ///< 0: one a core
  std::function<bool()> stop;                     ///< asked by several threads
  std::function<void(double, std::string_view)> progress;
};

/// An experiment as the list of them knows it.
struct ExperimentEntry {
  std::string_view name, title;
  Experiment (*run)(const ExperimentOptions&);
};

/// All experiments, in the order of the documents.
const std::vector<ExperimentEntry>& experiments();

std::string_view to_string(ClaimOutcome outcome);

}  // namespace limcycle
