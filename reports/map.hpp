#pragma once
#include <string>

#include "limcycle/analysis/status.hpp"
#include "limcycle/analysis/study/hunting_map.hpp"
#include "limcycle/reports/provenance.hpp"
#include "limcycle/reports/table.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// A map with what its reports say beside it.
struct MapReport {
  HuntingMap map;
  std::string x_unit, y_unit;  ///< of the parameters; "1" or empty: none
};

/// In how much of the map what happens, and what each method was worth, in sentences.
std::string map_answer(const MapReport& report);

/// For a terminal: the answer, the map in letters, two tables.
std::string map_text(const std::string& title, const MapReport& report);

/// JSON document of `map`; points that were not computed are null. `ended`: how the work did.
std::string map_json(const Provenance& provenance, const MapReport& report, Status ended = Status::converged);

/// One row a computed point.
std::string map_csv(const MapReport& report);

/// What happens, the amplitude, and what each method was worth, as SVG.
std::string map_picture(const MapReport& report, const Units& units);

/// Markup of picture and tables, under headings of this level (2: h2).
std::string map_sections(const MapReport& report, const Units& units, int level);

std::string map_page(const MapReport& report, const Provenance& provenance, const std::string& case_text,
                     const Units& units, const std::string& flags);

/// Shares of the map, by what happens; and by method and what it was worth.
Table happens_table(const MapReport& report);
Table worth_table(const MapReport& report);

/// What stands for a point in letters: '.' rest, 'H' hunting, '+' rest or hunting, ... ' ' not computed.
char map_letter(const std::optional<MapPoint>& point);

}  // namespace limcycle
