#pragma once
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/cases/loader/case.hpp"
#include "limcycle/questions/asking/asking.hpp"

namespace limcycle {

/// Every limit cycle of the loop, with the options of [search] and [predict]. Throws InputError if the case has no
/// loop, and std::invalid_argument if its numbers are valid but too extreme for a method. With the cause: see
/// add_cause(). `curves`: with those of the Nyquist figure.
PredictReport ask_predict(const Case& from, const Asking& asking, bool curves);

/// Adds why the loop hunts, if a prediction that came to its end found that it does within the search box. `options`:
/// those of the prediction; if they stop it, a note says so. Cost: see cause_of().
void add_cause(PredictReport& report, const LoopParts& parts, const PredictOptions& options);

}  // namespace limcycle
