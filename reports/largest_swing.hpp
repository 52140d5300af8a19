#pragma once
#include "limcycle/reports/adequacy/adequate.hpp"
#include "limcycle/reports/continuation/continue.hpp"
#include "limcycle/reports/continuation/margin.hpp"
#include "limcycle/reports/page/report.hpp"
#include "limcycle/reports/remedy/remedy.hpp"
#include "limcycle/reports/tune/tune.hpp"

namespace limcycle {

/// The largest swing of y that a report shows, in the unit of the case: of its cycles, or of its motions where it has
/// none. 0: it shows none.
double largest_swing(const PredictReport& report);
double largest_swing(const Simulation& run);
double largest_swing(const ContinueReport& report);
double largest_swing(const MarginReport& report);
double largest_swing(const MapReport& report);
double largest_swing(const SensitivityReport& report);
double largest_swing(const PrecisionReport& report);
double largest_swing(const AdequateReport& report);
double largest_swing(const LoopReport& report);
double largest_swing(const RemedyReport& report);
double largest_swing(const TuneReport& report);

}  // namespace limcycle
