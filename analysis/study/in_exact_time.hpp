#pragma once
#include <optional>
#include <string_view>

#include "limcycle/analysis/orbit/branch_map.hpp"

namespace limcycle {

/// The loop as the time domain treats it without any approximation: itself where it has no dead time, the dead time
/// behind the relay where the plant is driven through one (see in_time_domain). Nothing for other loops with a dead
/// time.
std::optional<Loop> in_exact_time(const Loop& loop);

/// The same of each loop of a family; empty too where the parameter's value is not valid.
LoopFamily in_exact_time(LoopFamily family);

/// Why a loop for which there is none has no cycles that can be followed: a clause.
inline constexpr std::string_view no_exact_time =
    "the dead time of this loop is exact in the time domain only behind a relay, so its limit cycles cannot be "
    "followed";

}  // namespace limcycle
