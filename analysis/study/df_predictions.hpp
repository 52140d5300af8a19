#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/study/loop_balance.hpp"
#include "limcycle/analysis/study/method_names.hpp"
#include "limcycle/analysis/study/predict.hpp"

namespace limcycle {

/// What the plain describing function says of a loop, before anything is simulated.
struct DfPredictions {
  static constexpr std::string_view method = df_name;
  std::vector<Prediction> predictions;  ///< with what their assumptions are worth
  std::vector<std::string> notes;       ///< where roots may be missing
  std::optional<Absence> absence;       ///< where nothing is predicted
  NyquistPicture nyquist;
  Status status = Status::converged;
};

/// All roots in the box as predictions, found with `max_evaluations` integrated describing functions at most. With
/// options.stop it ends early, and keeps the roots found.
DfPredictions df_predictions(const Loop& loop, const LoopBalance& balance, const SearchBox& box,
                             const PredictOptions& options, long max_evaluations);

}  // namespace limcycle
