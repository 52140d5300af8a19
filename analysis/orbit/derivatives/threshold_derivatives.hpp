#pragma once
#include <span>
#include <string>
#include <vector>

#include "limcycle/analysis/orbit/branch/continuation.hpp"
#include "limcycle/analysis/orbit/derivatives/cycle_derivatives.hpp"

namespace limcycle {

/// Derivative of the value p_k at which a cycle is lost by another parameter p_j, per unit of p_j.
struct ThresholdDerivative {
  double value = 0.0;
  double error = 0.0;  ///< estimated, absolute
};

/// Derivatives of a threshold by every other parameter.
struct ThresholdDerivatives {
  Status status = Status::converged;
  std::string why;                      ///< one sentence, if there is no result
  std::vector<ThresholdDerivative> by;  ///< in the order of `others`
};

/// Derivatives of the value of one parameter, p_k, at which a branch of cycles folds or changes its stability, given
/// the loop and the cycle there (what continue_cycle reports).
///
/// At a fold the equations of a cycle (cycle_derivatives) are singular: with the left null vector w of their matrix,
/// 0 = w . (dP/dp_k dp_k + dP/dp_j dp_j), so  dp_k/dp_j = -(w . dP/dp_j)/(w . dP/dp_k). At a change of stability the
/// multiplier m on the unit circle stays there: dp_k/dp_j = -(d|m|/dp_j)/(d|m|/dp_k).
///
/// `error` covers the difference of two integrations, and the distance of the cycle from the fold, estimated from the
/// ratio of the two smallest singular values. Status undefined: the branch ends otherwise (the border of the valid
/// range, a grazed switch); stalled: the cycle is not at the given threshold, or p_k does not move the threshold. Cost:
/// as cycle_derivatives, without multipliers at a fold.
ThresholdDerivatives threshold_derivatives(const Loop& loop, const Cycle& cycle, BranchEvent::Type type,
                                           const ParameterNeighbours& own, std::span<const ParameterNeighbours> others,
                                           const CycleDerivativeOptions& options = {});

}  // namespace limcycle
