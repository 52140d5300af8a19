#pragma once
#include "limcycle/analysis/orbit/branch_step.hpp"
#include "limcycle/analysis/orbit/continuation.hpp"

namespace limcycle {

/// One direction (the sign of ds) of a branch, from a solved first spot, with its events and its end. `closed`: it came
/// back to where it began.
Branch walk_branch(BranchMap& map, BranchSolver& solver, const ContinuationOptions& options, const BranchSpot& first,
                   double direction, bool& closed);

}  // namespace limcycle
