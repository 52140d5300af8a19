#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/energy/audit.hpp"
#include "limcycle/analysis/frequency/describing_function.hpp"
#include "limcycle/analysis/orbit/agreement.hpp"
#include "limcycle/analysis/study/predict.hpp"
#include "limcycle/reports/table.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// Results for a reader at a terminal, at most 80 columns wide, with units and no more digits than are right.

/// The answer in words, then cycles, predictions with verdicts, what each start reached, notes.
std::string predict_text(const std::string& title, const PredictReport& report, const Units& units);

/// All points up to `longest_table`; beyond that a summary and where to get them.
std::string df_text(const std::string& title, const std::vector<DfPoint>& points,
                    const std::vector<DescribingFunction>& results);
inline constexpr std::size_t longest_table = 200;

/// Summary of a run: how it ended, what the motion comes to, whether a second run agrees (if there was one), where the
/// energy went (if that was counted), the range of each column, the located events.
std::string simulate_text(const std::string& title, const Simulation& run,
                          const std::optional<Agreement>& second = std::nullopt,
                          const std::optional<EnergyBalance>& energy = std::nullopt, const Units& units = {});

/// Where the energy of a run came from and went to, without what is zero but for rounding.
Table energy_table(const EnergyBalance& energy);

/// Whether the energy of a run balances, one sentence; begins with "Warning" where it does not.
std::string energy_in_words(const EnergyBalance& energy);

/// What a second run says of `run`, one or two sentences; begins with "Warning" where they disagree.
std::string agreement_in_words(const Agreement& second);

/// "y(0) = 0.1 m": the name of a start of predict(), with the unit of y where it gives a value of y.
std::string start_in_words(const std::string& start, const Units& units);

/// The tables of predict_text, for other formats.
Table cycle_table(const PredictReport& report, const Units& units);
Table prediction_table(const PredictReport& report, const Units& units);
/// Trust indicators of the predictions that have them, and the bands in which the true cycles are proved (or guessed)
/// to lie.
Table trust_table(const PredictReport& report, const Units& units);

/// Whether the absence of oscillations is proved, in a sentence; empty where that was not asked.
std::string absence_in_words(const PredictReport& report);

/// What each method did, for --verbose: roots and residuals, runs with their steps, return maps. The same bytes however
/// many threads; no times. `methods`: those that were asked for.
std::string predict_efforts(const PredictReport& report, const Methods& methods, const Units& units = {});

}  // namespace limcycle
