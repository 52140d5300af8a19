#pragma once
#include "limcycle/analysis/study/adequacy/method_answers.hpp"

namespace limcycle {

/// The method "simulation": a plain one from every start of shooting, each until its swings repeat; the largest cycle
/// counts.
MethodAnswer plain_simulation(const Loop& loop, const PredictOptions& options, const SearchBox& box);

}  // namespace limcycle
