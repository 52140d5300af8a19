#pragma once
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// Metres and newtons for a mechanical loop and a lone element, else bare numbers; y in the unit of [units], if any.
Units units_of(const Case& from);

/// The same for a report whose largest swing of y is `swing`: metres that the case did not ask for become mm below 1 cm
/// and um below 0.1 mm.
Units units_of(const Case& from, double swing);

}  // namespace limcycle
