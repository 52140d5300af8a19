#pragma once
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Amplitude of y over that of the main element's input: converts the search box, which is for that input, to y.
///
/// It is exact if the two are the same motion in other units (the angle of a Froude pendulum and the rubbing of its
/// sleeve). If friction rubs elsewhere than at y, it is that of slow motions under a force on the plant, lim |y/x| for
/// s -> 0, rounded to six digits: 1 for the two masses of a drive, the flow per stroke of a valve. If that limit is
/// zero or infinite, |y/x| at the middle of the loop's poles. Otherwise 1. Predictions convert exactly, at their
/// frequency.
double output_per_input(const Loop& loop);

}  // namespace limcycle
