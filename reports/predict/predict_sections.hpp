#pragma once
#include <string>

#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

// Markup of the parts of a prediction, without headings unless there are several. An empty part states it in words,
// unless stated otherwise.

/// The cycles with their multipliers.
std::string cycle_tables(const PredictReport& report, const Units& units);

/// Predictions of each method, with their verdicts, and missed cycles.
std::string prediction_tables(const PredictReport& report, const Units& units);

/// Trust in the predictions and the absence of oscillations, under headings of this level (2: h2); empty if nothing was
/// predicted and absence was not requested.
std::string trust_sections(const PredictReport& report, const Units& units, int level);

/// Outcome of each start; empty without any.
std::string outcome_table(const PredictReport& report, const Units& units = {});

}  // namespace limcycle
