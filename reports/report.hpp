#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/energy/audit.hpp"
#include "limcycle/analysis/orbit/simulate.hpp"
#include "limcycle/analysis/study/dissipativity.hpp"
#include "limcycle/analysis/study/precision.hpp"
#include "limcycle/analysis/study/predict.hpp"
#include "limcycle/analysis/study/sensitivity.hpp"
#include "limcycle/models/loop.hpp"
#include "limcycle/reports/map.hpp"
#include "limcycle/reports/provenance.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// A part of a report: what was computed, or one sentence on why there is nothing.
template <class Result>
struct ReportPart {
  std::optional<Result> found{};
  std::string why_not{};
};

/// A run whose energy was counted.
struct CountedRun {
  std::string which;  ///< "the run of [simulate]"
  Simulation run;
  EnergyBalance energy;
};

/// All that one page says of a loop.
struct LoopReport {
  LoopParts loop;
  PredictReport predict;
  ReportPart<SensitivityReport> sensitivity;
  ReportPart<MapReport> map;
  ReportPart<CountedRun> energy;
  ReportPart<DissipativityReport> dissipativity;
  ReportPart<PrecisionReport> precision;
  bool interrupted = false;  ///< by the user: the page says so at its top
};

/// One self-contained page, in the order in which a reader asks: the answer and what each method was worth, the loop as
/// a block diagram, the cycles and how they look, the verdicts, what each start reaches, what moves the cycle, maps,
/// energy, which method to use, notes, and where all this comes from. It holds the case and the result of `predict` for
/// programs (case_in_page.hpp). `flags`: of the command, as typed.
std::string report_page(const LoopReport& report, const Provenance& provenance, const std::string& case_text,
                        const Units& units, const std::string& flags);

}  // namespace limcycle
