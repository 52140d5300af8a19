/// @file
/// Recognises a cell that a jump of the function crosses. (Internal to the root search.)
#pragma once

#include <optional>

#include "limcycle/analysis/frequency/roots/root_cell.hpp"

namespace limcycle {

/// A jump inside a cell: the samples of each side are close together, those of different sides apart.
struct RootJump {
  double height;    ///< smallest distance of a sample of one side from one of the other
  double spread;    ///< largest distance between samples of one side
  double distance;  ///< of zero from the convex hull of all samples
};

/// The jump that the samples show, or nothing: the sides must lie four times as far apart as the values spread on
/// either.
///
/// A describing function jumps where the amplitude at which an element begins to slip depends on the speed: a motion
/// that grazes the level either slips or does not. No bisection makes such a cell smaller in its values; as long as a
/// polynomial is put through its samples, it and its neighbours are bisected down to the last limit along the whole
/// jump. Between the sides there is no value of the function, so there is no root near a jump whose sides both keep
/// away from zero. A continuous function that is merely steep looks the same until its cells are small enough, hence
/// the depth that the caller demands. Cost: no evaluation.
std::optional<RootJump> jump_in(const CellSamples& values);

}  // namespace limcycle
