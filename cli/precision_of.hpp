#pragma once
#include "limcycle/analysis/study/precision.hpp"
#include "limcycle/cases/case.hpp"

namespace limcycle {

/// precision() of what a case holds: of its loop the cycle, of a case with [df] or with friction the describing
/// function, at the points of [df] or at some that represent the element.
PrecisionReport precision_of(const Case& from, const PrecisionOptions& options);

}  // namespace limcycle
