#pragma once
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/questions/asking.hpp"

namespace limcycle {

/// Every limit cycle of the loop, with the options of [search] and [predict]. Throws InputError if the case has no
/// loop, and std::invalid_argument if its numbers are valid but too extreme for a method.
PredictReport ask_predict(const Case& from, const Asking& asking);

}  // namespace limcycle
