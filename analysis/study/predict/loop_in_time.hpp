#pragma once
#include <string>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/models/delay.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// True if the dead time of the loop is exact in the time domain, because it acts on a relay's switches only, or if
/// there is no dead time.
bool exact_in_time(const Loop& loop);

/// The loop for simulations, and a note on the treatment of its dead time (empty: there is none).
struct LoopInTime {
  TimeDomainLoop treated;
  std::string note;
};

/// A dead time that is not exact becomes a Pade approximation of the lowest order that is accurate to 1e-9 up to the
/// seventh harmonic of `highest`, the largest frequency predicted (rad/s; 0: none), 40 rad over the delay at most.
LoopInTime loop_in_time(const Loop& loop, double highest);

/// Possible relative change of a cycle by the approximation of order `pade_order` (0: none): the distortion of the
/// delayed signal, harmonic by harmonic.
double delay_error(const Loop& loop, int pade_order, const Cycle& cycle);

}  // namespace limcycle
