#pragma once
#include <string>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/models/delay.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Is the dead time of the loop exact in the time domain, because it acts on a relay's switches only? Also true for a
/// loop without a dead time.
bool exact_in_time(const Loop& loop);

/// The loop as simulations take it, and a note on what was done to its dead time (empty: there is none).
struct LoopInTime {
  TimeDomainLoop treated;
  std::string note;
};

/// A dead time that is not exact becomes a Pade approximation of the lowest order that is right to 1e-9 up to the
/// seventh harmonic of `highest`, the largest frequency predicted (rad/s; 0: none), 40 rad over the delay at most.
LoopInTime loop_in_time(const Loop& loop, double highest);

/// What the approximation of order `pade_order` (0: none) may change in a cycle, relative: the distortion of the
/// delayed signal, harmonic by harmonic.
double delay_error(const Loop& loop, int pade_order, const Cycle& cycle);

}  // namespace limcycle
