#pragma once
#include <optional>
#include <span>
#include <vector>

#include "limcycle/analysis/lanes/isa.hpp"
#include "limcycle/analysis/study/map/hunting_map.hpp"

namespace limcycle {

/// Settings of the simulations of many points of a map.
struct SimulatedPoints {
  PredictOptions predict;  ///< its search box, its number of starts, its release of a load, and its `stop`
  Isa isa = best_isa();
};

/// True if simulated_points() marches this loop in lanes: many of them at a time take less than one by one.
bool fits_lanes(const Loop& loop);

/// The points of a map by simulation alone: no method is judged.
///
/// Loops that can be marched in lanes (see run_ensemble) are simulated from the starts of predict() only: no cycle is
/// solved for, none is looked for between the starts or below them, and unstable ones are not found; `cycles` and
/// `stable` count those that some start reached, whose amplitude and period are right to 1e-4. All other loops, and
/// those that the lanes leave undecided, are left to map_point() without methods.
///
/// Empty loops (values without a valid case) have no outcomes. A point does not depend on the others. Returns fewer
/// points than loops only if it was stopped. Cost: in lanes, a tenth to a fiftieth of map_point().
std::vector<MapPoint> simulated_points(std::span<const std::optional<Loop>> loops, const SimulatedPoints& how);

}  // namespace limcycle
