#pragma once
#include <functional>

#include "limcycle/analysis/frequency/root_search.hpp"
#include "limcycle/analysis/orbit/settle.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// How the motions of a loop are simulated when its limit cycles are looked for. Every command takes these settings, so
/// that no two of them disagree on a loop because one of them simulates it less accurately.
///
/// With A the amplitudes of `box` and U the amplitude of y per input of the element (output_per_input): swings of y
/// below U A_min have died out, |y| above 1e4 U A_max has diverged. rtol is 1e-7, or a tenth of the loosest tolerance
/// at which bristles as stiff as these stick (loosest_stiff_tolerance), if that is less; never below 1e-12. Shooting
/// solves a cycle to the relative error `accuracy` of period and amplitude.
SettleOptions cycle_search(const Loop& loop, const SearchBox& box, double accuracy, std::function<bool()> stop = {});

}  // namespace limcycle
