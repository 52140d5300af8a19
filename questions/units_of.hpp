#pragma once
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// Metres and newtons for a mechanical loop and a lone element, else bare numbers; y in the unit of [units], if any.
Units units_of(const Case& from);

}  // namespace limcycle
