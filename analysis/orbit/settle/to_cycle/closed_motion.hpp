#pragma once
#include "limcycle/analysis/orbit/cycle/shooting.hpp"

namespace limcycle {

/// A motion whose last swings repeat, nearly, those of one period before.
struct NearlyClosed {
  LoopState here;
  Trace period;         ///< the last period, up to about here
  long steps = 0;       ///< of the march in it
  bool odd = false;     ///< its halves may mirror each other: the loop is odd, and half of the turns are an odd number
  double change = 0.0;  ///< largest relative change of a swing in one period
  double swing = 0.0;   ///< of y
  double offset = 0.0;  ///< of the middle of y from that of the odd symmetry, relative to the swing; 0 if there is none
};

NearlyClosed nearly_closed(const Loop& loop, LoopState here, Trace period, std::size_t turns, double change);

/// True if the motion lies too far beside the mirrored one to be symmetric.
bool is_displaced(const NearlyClosed& motion);
/// True if it hardly moves on in a period.
bool has_settled(const NearlyClosed& motion);

/// What shooting found from such a motion.
struct ClosedMotion {
  ShootingResult shot;
  bool half = false;  ///< of the half map
  Section section;
  ShootingOptions shooting;
  long steps = 0;  ///< of all return maps
};

/// Shoots at the cycle of a motion: by half periods if the loop is odd and the motion is symmetric, or hardly moves on
/// in a period (beside a symmetric cycle whose multiplier is close to 1 it may lie far from it); by whole periods if
/// not, or if there is no symmetric cycle.
ClosedMotion close_motion(const Loop& loop, const NearlyClosed& motion, const ShootingOptions& options);

}  // namespace limcycle
