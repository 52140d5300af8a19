#pragma once
#include <optional>
#include <string_view>

#include "limcycle/analysis/orbit/branch/branch_map.hpp"

namespace limcycle {

/// The loop for the time domain without any approximation: unchanged if it has no dead time, with the dead time behind
/// the relay if the plant is driven through one (see in_time_domain). Nothing for other loops with a dead time, nor for
/// one with a sampled controller, whose cycles change in steps of its samples if they have a period at all.
std::optional<Loop> in_exact_time(const Loop& loop);

/// The same of each loop of a family; also empty if the parameter's value is not valid.
LoopFamily in_exact_time(LoopFamily family);

/// Reason, as a clause, why cycles of a loop without an exact form cannot be followed.
std::string_view why_not_followed(const Loop& loop);

}  // namespace limcycle
