#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/energy/loop/audit.hpp"
#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"
#include "limcycle/analysis/orbit/cycle/agreement.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/reports/format/document.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// Results for a reader at a terminal, at most 80 columns wide, with units and accurate digits only.

/// The answer in words, then cycles, predictions with verdicts, the outcome of each start, notes.
std::string predict_text(const std::string& title, const PredictReport& report, const Units& units);
Document predict_document(const std::string& title, const PredictReport& report,
                          const Units& units);  ///< the same, with its tables

/// All points up to `longest_table`; beyond that a summary and a hint to the other formats.
std::string df_text(const std::string& title, const std::vector<DfPoint>& points,
                    const std::vector<DescribingFunction>& results);
Document df_document(const std::string& title, const std::vector<DfPoint>& points,
                     const std::vector<DescribingFunction>& results);  ///< the same, with its tables
inline constexpr std::size_t longest_table = 200;

/// Summary of a run: how it ended, its outcome, agreement with a second run (if there was one), energy balance (if
/// computed), the range of each column, the located events.
std::string simulate_text(const std::string& title, const Simulation& run,
                          const std::optional<Agreement>& second = std::nullopt,
                          const std::optional<EnergyBalance>& energy = std::nullopt, const Units& units = {});
Document simulate_document(const std::string& title, const Simulation& run,
                           const std::optional<Agreement>& second = std::nullopt,
                           const std::optional<EnergyBalance>& energy = std::nullopt,
                           const Units& units = {});  ///< the same, with its tables

/// Energy balance of a run, without terms that are zero to rounding.
Table energy_table(const EnergyBalance& energy);

/// Quality of the energy balance of a run, one sentence; begins with "Warning" if it does not balance.
std::string energy_in_words(const EnergyBalance& energy);

/// Agreement with a second run, one or two sentences; begins with "Warning" if they disagree.
std::string agreement_in_words(const Agreement& second);

/// "y(0) = 0.1 m": the name of a start of predict(), with the unit of y if it gives a value of y.
std::string start_in_words(const std::string& start, const Units& units);

/// The tables of predict_text, for other formats.
Table cycle_table(const PredictReport& report, const Units& units);
Table prediction_table(const PredictReport& report, const Units& units);
/// Trust indicators of the predictions that have them, and the bands that are proved (or guessed) to contain the true
/// cycles.
Table trust_table(const PredictReport& report, const Units& units);

/// Result on the absence of oscillations, in a sentence; empty if it was not requested.
std::string absence_in_words(const PredictReport& report);

/// Work of each method, for --verbose: roots and residuals, runs with their steps, return maps. The same bytes for any
/// number of threads; no times. `methods`: those requested.
std::string predict_efforts(const PredictReport& report, const Methods& methods, const Units& units = {});

}  // namespace limcycle
