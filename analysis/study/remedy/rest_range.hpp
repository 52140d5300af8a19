#pragma once
#include <optional>

#include "limcycle/analysis/energy/loop/holding_forces.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Least and largest y of all states in which a loop with at most one friction law stands still: A X + B w + E ext = 0,
/// rubbing velocity 0, the friction any force that the law holds, dead zones, windows, saturations and relays on any of
/// their straight pieces, a friction compensation anywhere between its levels (which may be more than it can take
/// there), a reset integrator at any output with an input of zero, a clamped one also at its limit. For each choice of
/// pieces this is a linear programme of few unknowns; its ends are found among its corners. Without such elements it is
/// the output of stuck_set(). Ends that nothing bounds are infinite. Empty: no state stands still, the reference moves,
/// or the loop has an element of another kind. Cost: O(n^3) for each choice of pieces.
std::optional<Extent> rest_range(const Loop& loop);

}  // namespace limcycle
