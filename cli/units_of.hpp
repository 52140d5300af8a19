#pragma once
#include "limcycle/models/loop.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// Metres and newtons where there is something mechanical, else bare numbers.
Units units_of(const LoopParts& loop);

}  // namespace limcycle
