#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/tune/tune.hpp"
#include "limcycle/reports/format/document.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/provenance.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// The least cost without hunting and where it is, what bounds it, and whether the local searches agree. The report
/// stays in the units of the case here and below; y is converted while it is printed.
std::string tune_answer(const TuneReport& report, const Units& units);

/// For a terminal: the answer, the numbers, the costs before and after, the searches, the points by outcome.
std::string tune_text(const std::string& title, const TuneReport& report, const Units& units);
Document tune_document(const std::string& title, const TuneReport& report,
                       const Units& units);  ///< the same, with its tables

std::string tune_json(const Provenance& provenance, const TuneReport& report);

/// One row a point.
std::string tune_csv(const TuneReport& report);

/// The map of the search, as SVG: the points over each pair of numbers, or over one number their costs (at the top
/// those without); coloured by outcome, feasible ones by their cost.
std::string tune_picture(const TuneReport& report, const Units& units);

/// The same as the text, with the map of the search and the step response before and after. `flags`: as typed.
std::string tune_page(const TuneReport& report, const Provenance& provenance, const std::string& case_text,
                      const Units& units, const std::string& flags);

/// Numbers with bounds and surroundings; costs before and after; local searches; points by outcome.
Table tune_number_table(const TuneReport& report);
Table tune_cost_table(const TuneReport& report, const Units& units);
Table tune_search_table(const TuneReport& report, const Units& units);
Table tune_outcome_table(const TuneReport& report);

/// The last word of each path, or the whole path without "loop." where two numbers share it.
std::vector<std::string> tune_names(const TuneReport& report);

/// "settling time", and so on.
std::string tune_cost_name(TuneCost cost);

/// A cost with its unit, as printed.
std::string tune_cost_in_words(double cost, const TuneReport& report, const Units& units);

/// "feasible" as "does not hunt", and so on.
std::string outcome_in_words(TuneOutcome outcome);

}  // namespace limcycle
