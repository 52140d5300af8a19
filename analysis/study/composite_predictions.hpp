#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/composite_balance.hpp"
#include "limcycle/analysis/study/predict.hpp"

namespace limcycle {

/// What the composite describing function predicts of a loop.
struct CompositePredictions {
  std::vector<Prediction> predictions;
  std::vector<CompositeRoot> roots;  ///< of the predictions, in their order
  std::vector<std::string> notes;    ///< where roots may be missing
  Effort effort;
  Status status = Status::converged;
};

/// All roots between the frequencies of the box, found with `max_steps` steps of the integrator at most.
CompositePredictions composite_predictions(CompositeBalance& balance, const SearchBox& box, long max_steps,
                                           const std::function<bool()>& stop);

}  // namespace limcycle
