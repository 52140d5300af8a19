#pragma once
#include <string>

#include "limcycle/analysis/status.hpp"
#include "limcycle/analysis/study/map/hunting_map.hpp"
#include "limcycle/reports/format/document.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/provenance.hpp"
#include "limcycle/reports/units.hpp"

namespace limcycle {

/// A map with the additional data of its reports.
struct MapReport {
  HuntingMap map;
  std::string x_unit, y_unit;  ///< of the parameters; "1" or empty: none
};

/// Shares of the map with each behaviour, and the quality of each method, in sentences.
std::string map_answer(const MapReport& report);

/// For a terminal: the answer, the map in letters, two tables.
std::string map_text(const std::string& title, const MapReport& report);
Document map_document(const std::string& title, const MapReport& report);  ///< the same, with its tables

/// JSON document of `map`; points that were not computed are null. `ended`: status of the work.
std::string map_json(const Provenance& provenance, const MapReport& report, Status ended = Status::converged);

/// One row a computed point.
std::string map_csv(const MapReport& report);

/// Behaviour, amplitude, and quality of each method, as SVG.
std::string map_picture(const MapReport& report, const Units& units);

/// Markup of picture and tables, under headings of this level (2: h2).
std::string map_sections(const MapReport& report, const Units& units, int level);

std::string map_page(const MapReport& report, const Provenance& provenance, const std::string& case_text,
                     const Units& units, const std::string& flags);

/// Shares of the map, by behaviour; and by method and its quality.
Table happens_table(const MapReport& report);
Table worth_table(const MapReport& report);

/// Letter of a point: '.' rest, 'H' hunting, '+' rest or hunting, ... ' ' not computed.
char map_letter(const std::optional<MapPoint>& point);

}  // namespace limcycle
