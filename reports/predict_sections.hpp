#pragma once
#include <string>

#include "limcycle/analysis/study/predict.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

// Markup of the parts of a prediction, without headings but where there are several. A part says in words that there is
// nothing, unless told otherwise.

/// The cycles with their multipliers.
std::string cycle_tables(const PredictReport& report, const Units& units);

/// What each method predicts, with its verdict, and what was missed.
std::string prediction_tables(const PredictReport& report, const Units& units);

/// Trust in the predictions and the absence of oscillations, under headings of this level (2: h2); empty where nothing
/// was predicted and absence was not asked.
std::string trust_sections(const PredictReport& report, const Units& units, int level);

/// What each start reaches; empty without any.
std::string outcome_table(const PredictReport& report, const Units& units = {});

}  // namespace limcycle
