#pragma once
#include "limcycle/models/loop.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// Metres and newtons for a mechanical loop, else bare numbers.
Units units_of(const LoopParts& loop);

}  // namespace limcycle
