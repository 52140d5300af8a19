#pragma once
#include "limcycle/reports/adequacy/adequate.hpp"
#include "limcycle/reports/continuation/continue.hpp"
#include "limcycle/reports/continuation/margin.hpp"
#include "limcycle/reports/page/report.hpp"

namespace limcycle {

/// True if the name of a start ends with a displacement of y.
bool names_displacement(const std::string& start);

/// Results with y in the unit that the case wants to see, for texts, pages and pictures: everything that has the unit
/// of y, or of y over another one, is multiplied by units.y_per_si. Documents (JSON, CSV) are made of the results
/// themselves. What is in the unit of the element's input stays.
PredictReport in_units(PredictReport report, const Units& units);
Simulation in_units(Simulation run, const Units& units);
ContinueReport in_units(ContinueReport report, const Units& units);
MarginReport in_units(MarginReport report, const Units& units);
MapReport in_units(MapReport report, const Units& units);
SensitivityReport in_units(SensitivityReport report, const Units& units);
PrecisionReport in_units(PrecisionReport report, const Units& units);
AdequateReport in_units(AdequateReport report, const Units& units);
LoopReport in_units(LoopReport report, const Units& units);

/// The factor the other way.
Units in_si(const Units& units);

}  // namespace limcycle
