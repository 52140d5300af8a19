#pragma once
#include "limcycle/analysis/orbit/branch/branch_step.hpp"
#include "limcycle/analysis/orbit/branch/continuation.hpp"

namespace limcycle {

/// One direction (the sign of ds) of a branch, from a solved first spot, with its events and its end. `closed`: it
/// returned to its start.
Branch walk_branch(BranchMap& map, BranchSolver& solver, const ContinuationOptions& options, const BranchSpot& first,
                   double direction, bool& closed);

}  // namespace limcycle
