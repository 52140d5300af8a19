#pragma once
#include <string>

#include "limcycle/analysis/status.hpp"
#include "limcycle/analysis/study/sensitivity/sensitivity.hpp"
#include "limcycle/reports/format/document.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/provenance.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// Strongest influence on the cycle, probability of hunting over the spread, and the numbers that decide it.
std::string sensitivity_answer(const SensitivityReport& report);

/// For a terminal: the answer and the tables below.
std::string sensitivity_text(const std::string& title, const SensitivityReport& report, const Units& units);
Document sensitivity_document(const std::string& title, const SensitivityReport& report,
                              const Units& units);  ///< the same, with its tables

/// JSON document of `sensitivity`. `ended`: status of the work.
std::string sensitivity_json(const Provenance& provenance, const SensitivityReport& report,
                             Status ended = Status::converged);

/// One row a number, distinguished by the first column `kind`: local, predicted, threshold, one-at-a-time, morris,
/// sobol, interaction.
std::string sensitivity_csv(const SensitivityReport& report);

std::string sensitivity_page(const SensitivityReport& report, const Provenance& provenance,
                             const std::string& case_text, const Units& units, const std::string& flags);

/// Markup of the results, under headings of this level (2: h2) and below; empty without results.
std::string sensitivity_sections(const SensitivityReport& report, const Units& units, int level);

/// Notes for the reader: those of the study, and numbers without a derivative.
std::vector<std::string> sensitivity_notes(const SensitivityReport& report);

/// Per cent of a quantity for each per cent of a number; 0 if the derivative is within its error.
std::string per_cent(double derivative, double error, double value, double quantity);

Table derivative_table(const SensitivityReport& report, const Units& units);
/// First harmonic and offset.
Table harmonic_table(const SensitivityReport& report, const Units& units);
/// Amplitude and frequency of an oscillation that the describing function predicts.
Table predicted_table(const PredictedOscillation& predicted, const Units& units);
/// The gain there, at constant amplitude and frequency.
Table gain_table(const PredictedOscillation& predicted, const Units& units);
/// "What the describing function predicts", with its number if there are several.
std::string predicted_heading(const SensitivityReport& report, std::size_t index);
Table threshold_table(const ThresholdSensitivity& threshold);
/// One sentence: the threshold, and the change there.
std::string threshold_sentence(const ThresholdSensitivity& threshold);
/// One sentence: amplitude, frequency and gain.
std::string predicted_sentence(const PredictedOscillation& predicted, const Units& units);
Table change_table(const SensitivityReport& report, const Units& units);
Table morris_table(const SensitivityReport& report, const OutputSensitivity& output);
Table band_table(const SensitivityReport& report, const Units& units);  ///< of the outputs over the spread
Table sobol_table(const SensitivityReport& report, const OutputSensitivity& output);

/// Elasticities of amplitude and period, the largest on top.
std::string tornado_picture(const SensitivityReport& report);
/// Elasticities of a threshold, the largest on top.
std::string threshold_picture(const ThresholdSensitivity& threshold);
/// First and total indices of an output with their intervals, and their convergence with the number of samples.
std::string indices_picture(const SensitivityReport& report, const OutputSensitivity& output);
/// First indices and those of pairs, as a matrix; empty without second order.
std::string interactions_picture(const SensitivityReport& report, const OutputSensitivity& output);
/// Share of the loops that hunt over the two parameters that decide it most; empty if they are not known.
std::string hunting_heat_picture(const SensitivityReport& report);
/// The fair sample: amplitude, or hunting or not, over each parameter.
std::string scatter_picture(const SensitivityReport& report);

}  // namespace limcycle
