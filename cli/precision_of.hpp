#pragma once
#include "limcycle/analysis/study/precision/precision.hpp"
#include "limcycle/cases/loader/case.hpp"

namespace limcycle {

/// precision() for a case: of its loop the cycle, of a case with [df] or with friction the describing function, at the
/// points of [df] or at some that represent the element.
PrecisionReport precision_of(const Case& from, const PrecisionOptions& options);

}  // namespace limcycle
