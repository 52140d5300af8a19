#pragma once
#include <string>
#include <utility>
#include <vector>

#include "limcycle/analysis/study/remedy/loop_costs.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// Costs of several loops, one a row after its name; the first column has this heading.
using NamedCosts = std::vector<std::pair<std::string, const RemedyCosts*>>;
Table cost_table(const std::string& heading, const NamedCosts& loops, const Units& units);

/// What its columns mean, a sentence; `step`: height of the step.
std::string cost_legend(double step, const Units& units);

/// The text of a JSON object.
std::string costs_json(const RemedyCosts& costs);

}  // namespace limcycle
