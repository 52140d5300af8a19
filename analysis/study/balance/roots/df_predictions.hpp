#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"
#include "limcycle/analysis/study/predict/method_names.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// Predictions of the plain describing function for a loop, before any simulation.
struct DfPredictions {
  static constexpr std::string_view method = df_name;
  std::vector<Prediction> predictions;  ///< with an assessment of their assumptions
  std::vector<std::string> notes;       ///< regions in which roots may be missing
  std::optional<Absence> absence;       ///< proof of absence, if nothing is predicted
  bool exists = false;                  ///< the describing function, in the box; false too after a stop
  Status status = Status::converged;
};

/// All roots in the box as predictions, found with at most `max_evaluations` integrated describing functions. With
/// options.stop it ends early, and keeps the roots found.
DfPredictions df_predictions(const Loop& loop, const FirstHarmonicBalance& balance, const SearchBox& box,
                             const PredictOptions& options, long max_evaluations);

}  // namespace limcycle
