#pragma once
#include "limcycle/analysis/study/identify/fit.hpp"

namespace limcycle {

/// Error of a law on rows that it was not fitted to: the root of the mean square of (force - measured)/(largest force
/// of the record), of a free motion of its positions and velocities, over five parts. Each part is a fifth of every
/// record, in blocks of consecutive rows; for it the law is fitted to the other four by one Gauss-Newton step from the
/// fit to all, on the bounds of that fit and within all others, and then driven through the whole motion. The states at
/// the starts of free motions, too, are fitted to the other four parts; those of a run that lies in the part, to its
/// own rows, which its number of states makes up for. Cost: six evaluations, with free motions eleven. NaN if the law
/// has no answer.
double held_out_error(const Misfit& misfit, const Fit& best);

}  // namespace limcycle
