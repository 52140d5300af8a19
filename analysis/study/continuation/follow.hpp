#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/orbit/branch/continuation.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// Options of follow_cycles().
struct FollowOptions {
  ContinuationOptions continuation;  ///< from, to; its stop and progress are set from those of `predict`
  PredictOptions predict;            ///< search for cycles at the start; its search box is for the case's own value
  std::optional<double> own;         ///< the case's own value, if it has one
  int scan = 12;                     ///< number of values tried over the range if there is no cycle at the start
};

/// Every branch of limit cycles that passes through one value of a parameter.
struct FollowReport {
  double from = 0.0, to = 0.0;
  double start = 0.0;  ///< the value at which the search for cycles was made
  std::vector<Branch> branches;
  std::vector<std::string> notes;
  std::string refused{};              ///< reason why this loop was not followed at all, a clause; else empty
  Status status = Status::converged;  ///< no_cycle: none was found at any value tried
};

/// Finds the limit cycles at the case's own value (or at `from`, if that lies outside the range; or, if there are none,
/// at the first of `scan` values over the range that has one) by predict(), and follows each of them that is not on a
/// branch already. Throws std::invalid_argument for a bad range.
FollowReport follow(const LoopFamily& family, const FollowOptions& options);

/// True if the branch passes through this cycle at this value of the parameter (by its points).
bool passes(const Branch& branch, double parameter, const Cycle& cycle);

}  // namespace limcycle
