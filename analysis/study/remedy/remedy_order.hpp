#pragma once
#include <vector>

#include "limcycle/analysis/study/remedy/remedy.hpp"

namespace limcycle {

/// Marks the best remedies and sorts: those that end hunting first, the best of them first or, with weights, by the
/// weighted sum of their costs, each as a share of the way from the least to the greatest of all (an unknown one counts
/// as the greatest); then those not decided, those that do not end it, and those that do not apply.
void order_remedies(std::vector<Remedy>& remedies, const CostWeights& weights);

}  // namespace limcycle
