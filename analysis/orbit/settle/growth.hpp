#pragma once
#include <functional>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/orbit/settle/watch/turning_points.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// True if the swings grow like a power of time, as a limited command allows an unstable loop, and not towards a cycle:
/// each doubling of their number increases them by more than the one before, by at least a quarter. On the way to a
/// cycle it increases them by less and less. Needs 64 swings.
/// Any slow growth begins like a line, and one into a cycle may look like a power on its way: see grows_from_afar().
bool grows_like_a_power(const TurningPoints& turning);

/// True if the turning points move one way from each period to the next, in the whole second half of the run: the
/// motion is on its way from somewhere, or to somewhere, and no permanent one. Needs 64 turning points.
bool drifts(const TurningPoints& turning);

/// True if the motion from this state, moved 30 times as far from rest, grows too, and 900 and 27,000 times as far does
/// not shrink: its later swings are no smaller than its first ones, and it is still far out, compared with `swing`,
/// that of the motion here. Where friction and other limited forces stand against a growth they are weaker there still;
/// what bounds a growth, such as damping, is stronger. Cost: thirty swings, or `most_steps` of a march without an
/// answer.
bool grows_from_afar(const Loop& loop, const LoopState& here, double swing, double rtol, long most_steps,
                     const std::function<bool()>& stop);

}  // namespace limcycle
