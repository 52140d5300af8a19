#pragma once
#include "limcycle/analysis/cycle.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// The state moved away from the rest point of the linear part by a factor; elements keep their states and modes.
LoopState scaled(const Loop& loop, const LoopState& state, double factor);

}  // namespace limcycle
