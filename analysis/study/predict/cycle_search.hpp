#pragma once
#include <functional>
#include <vector>

#include "limcycle/analysis/frequency/roots/root_search.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Settings of the simulations that search for limit cycles of a loop. Every command uses them, so that no two of them
/// disagree on a loop because one simulates it less accurately.
///
/// With A the amplitudes of `box` and U the amplitude of y per input of the element (output_per_input): swings of y
/// below U A_min have died out, |y| above 1e4 U A_max, and 1e4 quanta of a sampled reading, has diverged. rtol is 1e-7,
/// or a tenth of the loosest tolerance at which such stiff bristles stick (loosest_stiff_tolerance), if that is less;
/// never below 1e-12. Shooting solves a cycle to the relative error `accuracy` of period and amplitude.
SettleOptions cycle_search(const Loop& loop, const SearchBox& box, double accuracy, std::function<bool()> stop = {});

/// For a box in which every start diverges: extends it downwards by six decades, and returns displacements from which
/// to simulate then, up to three of `starts`, each a hundredth of the one before and the first of `smallest`.
std::vector<double> extend_down(SearchBox& box, double smallest, int starts);

}  // namespace limcycle
