#pragma once
#include <optional>

#include "limcycle/analysis/orbit/settle/to_cycle/closed_motion.hpp"

namespace limcycle {

/// The end of a slow drift, as far as it was followed.
struct Drift {
  std::optional<LoopState> to;  ///< on the section of the motion; empty if it could not be followed
  double time = 0.0;            ///< s, from the motion to there
  long steps = 0;               ///< of the integrator
};

/// Follows a motion that nearly repeats itself but moves on a little in each period, as beside a cycle whose multiplier
/// is close to 1, over many periods at once (projective integration: C. W. Gear, I. G. Kevrekidis, SIAM J. Sci. Comput.
/// 24, 2003). With d the change of the state in a period and g the factor by which it grows in one, a leap over m
/// periods is d (g + g^2 + ... + g^m); two return maps follow, in the first of which other deviations die out. m is
/// such that d changes by a fifth at first, by a factor of up to two later, and that the motion changes by at most 5 %
/// of its size. A leap counts only if d has kept its direction (within ten degrees) and its size is as foretold to 50
/// %, so that no cycle is passed; else a shorter one takes its place. Ends where the state has moved on by 30 % of the
/// size of the motion, where d changes too fast for leaps, where it is less than 1e4 times the tolerance of the maps
/// (1e-8 to 1e-12, as d needs it), or where the motion no longer returns. Cost: two maps a leap, about three leaps for
/// each factor of two in d.
Drift follow_drift(const Loop& loop, const NearlyClosed& motion, const ShootingOptions& options);

}  // namespace limcycle
