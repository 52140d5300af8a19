#pragma once
#include <functional>

#include "limcycle/analysis/study/identify/fit.hpp"

namespace limcycle {

/// The best fit that is found without a start of the user's, in stages: the numbers that steady velocities determine,
/// from those records; the rest, from the others; then all together, within the bounds. Each of the first two stages
/// begins at points of a Halton sequence over the ranges of the space, goes on a little from the best few, and to the
/// end from the best of these. The same records give the same fit. Records in use: all, afterwards.
Fit fit_from_starts(Misfit& misfit, const std::function<bool()>& stop);

/// The same or a better fit: one whose break-away level came out at the sliding level, so that the records say nothing
/// of the velocity between them, is begun anew from a higher level and three velocities. A noisy free motion has such
/// minima.
Fit begun_off_levels(const Misfit& misfit, const Fit& best, const std::function<bool()>& stop);

}  // namespace limcycle
