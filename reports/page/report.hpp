#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/energy/loop/audit.hpp"
#include "limcycle/analysis/orbit/simulate/simulate.hpp"
#include "limcycle/analysis/study/continuation/margin.hpp"
#include "limcycle/analysis/study/dissipativity.hpp"
#include "limcycle/analysis/study/precision/precision.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"
#include "limcycle/analysis/study/remedy/remedy.hpp"
#include "limcycle/analysis/study/sensitivity/sensitivity.hpp"
#include "limcycle/models/loop.hpp"
#include "limcycle/reports/map/map.hpp"
#include "limcycle/reports/provenance.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// A part of a report: its result, or one sentence on the reason for its absence; neither if it was not asked for.
template <class Result>
struct ReportPart {
  std::optional<Result> found{};
  std::string why_not{};
};

/// A run with its energy balance.
struct CountedRun {
  std::string which;  ///< "the run of [simulate]"
  Simulation run;
  EnergyBalance energy;
};

/// Contents of the page about a loop.
struct LoopReport {
  LoopParts loop;
  PredictReport predict;
  ReportPart<MarginReport> margin;
  ReportPart<RemedyReport> remedy;
  ReportPart<SensitivityReport> sensitivity;
  ReportPart<MapReport> map;
  ReportPart<CountedRun> energy;
  ReportPart<DissipativityReport> dissipativity;
  ReportPart<PrecisionReport> precision;
  bool interrupted = false;  ///< by the user: stated at the top of the page
};

/// One self-contained page, in the order of a reader's questions: the answer and the quality of each method, what
/// would change it, the loop as a block diagram, the cycles and their figures, the verdicts, the outcome of each start,
/// sensitivity, maps, energy, the choice of a method, notes, and provenance. It contains the case and the result of
/// `predict` for programs (case_in_page.hpp). `flags`: of the command, as typed.
std::string report_page(const LoopReport& report, const Provenance& provenance, const std::string& case_text,
                        const Units& units, const std::string& flags);

}  // namespace limcycle
