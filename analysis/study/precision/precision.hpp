#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/study/precision/cycle_methods.hpp"
#include "limcycle/analysis/study/precision/df_precision.hpp"
#include "limcycle/analysis/study/precision/stiffness.hpp"

namespace limcycle {

/// Options of a work-precision study.
struct PrecisionOptions {
  CycleMethodsOptions cycle;  ///< predict.search is the box of the describing function
  DfPrecisionOptions df;
  std::vector<double> stiff_tolerances{1e-4, 1e-6, 1e-8};
  int stiff_periods = 4;
  long stiff_max_steps = 400000;
  bool stiffness = true;
  int threads = 1;                 ///< 0: one per core. More disturb each other's times a little
  WorkOptions work;                ///< stop is used throughout, by all threads
  std::vector<WorkMethod> more{};  ///< further methods for the cycle, rated like the others
  std::function<void(double, std::string_view)> progress;  ///< fraction done (0..1), current activity
};

/// A work-precision chart for one question.
struct WorkChart {
  std::string question;   ///< "cycle", "describing-function"
  bool answered = false;  ///< there is a verified reference
  std::string made_by, verified_by;
  double agreement = not_known;  ///< relative difference of the reference and the second method
  double floor = not_known;      ///< smaller errors cannot be distinguished: the uncertainty of the reference
  std::string why;               ///< unless answered: one sentence
  std::vector<WorkPoint> points;
  std::vector<std::size_t> front;       ///< see pareto_front
  std::vector<std::string> methods;     ///< in order of appearance
  std::vector<std::string> never_best;  ///< those that are never on the front
};

/// Results of a work-precision study.
struct PrecisionReport {
  std::optional<CycleReference> cycle;
  std::optional<WorkChart> cycle_chart;  ///< if the case has a loop
  std::optional<WorkChart> df_chart;     ///< if an element is given
  std::vector<DfPoint> df_points;
  StiffnessStudy stiffness;
  std::vector<std::string> notes;
  Status status = Status::converged;
};

/// Completes a chart from its points.
void conclude(WorkChart& chart);

/// Speed against accuracy of every method that applies. `parts`: the loop, or null; `element`: the element of the
/// describing function, at `points`, or null. Seconds differ from run to run; errors and evaluations do not.
PrecisionReport precision(const LoopParts* parts, const Element* element, const std::vector<DfPoint>& points,
                          const PrecisionOptions& options);

}  // namespace limcycle
