#pragma once
#include <functional>
#include <string>
#include <vector>

#include "limcycle/analysis/study/experiments/experiment.hpp"

namespace limcycle {

/// Contribution of one law to an experiment.
struct LawPart {
  std::vector<Measured> rows;
  std::string finding;
  Status status = Status::converged;
  /// For each figure the panels of this law; their titles follow the law's own.
  std::vector<std::vector<FigurePanel>> panels;

  void add(std::size_t figure, Curve curve, const std::string& title = {});
};

/// Runs `one` for every law of the options that exists, several at a time, and joins the parts in the order of the
/// laws: the result does not depend on the threads. A law that the experiment cannot treat (std::invalid_argument) gets
/// a finding with the reason. Stopped early: Status::interrupted, with the results so far.
void run_by_law(Experiment& experiment, const ExperimentOptions& options,
                const std::function<LawPart(const LawSetting&)>& one);

/// A curve of at most about `most` points, evenly spaced along its drawing: corners and jumps stay, and rests take few
/// points.
Curve thinned(std::string name, const std::vector<double>& x, const std::vector<double>& y, std::size_t most = 300);

/// True if this law was measured.
bool has_law(const Experiment& experiment, const std::string& law);

/// "1.23e-06 m": a number in a sentence.
std::string quantity(double value, const std::string& unit, int digits = 3);

/// "+12 %": change from `from` to `to`.
std::string change(double from, double to);

}  // namespace limcycle
