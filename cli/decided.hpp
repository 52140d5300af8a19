#pragma once
#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// True if the loop is known to have a limit cycle, or the outcome of at least one start was determined.
bool decided(const PredictReport& report);

}  // namespace limcycle
