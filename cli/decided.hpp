#pragma once
#include "limcycle/analysis/study/predict.hpp"

namespace limcycle {

/// Is it known what the loop does: does it have a limit cycle, or was the outcome of at least one start determined?
bool decided(const PredictReport& report);

}  // namespace limcycle
