#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/composite/composite_balance.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// Predictions of the composite describing function for a loop.
struct CompositePredictions {
  std::vector<Prediction> predictions;
  std::vector<CompositeRoot> roots;  ///< of the predictions, in their order
  std::vector<std::string> notes;    ///< regions in which roots may be missing
  Effort effort;
  Status status = Status::converged;
};

/// All roots between the frequencies of the box, found with at most `max_steps` steps of the integrator.
CompositePredictions composite_predictions(CompositeBalance& balance, const SearchBox& box, long max_steps,
                                           const std::function<bool()>& stop);

}  // namespace limcycle
