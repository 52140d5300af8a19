#include <cmath>

#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/map/map.hpp"

namespace limcycle {
namespace {

Json axis_json(const MapAxis& axis, const std::string& unit) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(axis.points));
  for (int i = 0; i < axis.points; ++i) values.push_back(axis.value(i));
  return {{"parameter", axis.path}, {"unit", unit}, {"values", numbers(values)}, {"logarithmic", axis.logarithmic}};
}

Json map_point_json(const HuntingMap& map, std::size_t k) {
  const auto& point = map.points[k];
  if (!point) return nullptr;
  Json outcomes = Json::array(), methods = Json::array();
  for (const Outcome outcome : point->outcomes) outcomes.push_back(to_string(outcome));
  for (std::size_t m = 0; m < point->methods.size(); ++m)
    methods.push_back({{"method", map.methods[m]},
                       {"worth", to_string(point->methods[m].worth)},
                       {"amplitude_ratio", number(point->methods[m].amplitude)},
                       {"frequency_ratio", number(point->methods[m].frequency)}});
  return {{"x", map.x_of(k)},
          {"y", map.y_of(k)},
          {"happens", point->in_words()},
          {"outcomes", outcomes},
          {"cycles", point->cycles},
          {"stable_cycles", point->stable},
          {"amplitude", number(point->amplitude)},
          {"period", number(point->period)},
          {"methods", methods}};
}

}  // namespace

std::string map_json(const Provenance& provenance, const MapReport& report, Status ended) {
  Json points = Json::array();
  for (std::size_t k = 0; k < report.map.size(); ++k) points.push_back(map_point_json(report.map, k));
  const Json body = {{"answer", map_answer(report)},
                     {"x", axis_json(report.map.x, report.x_unit)},
                     {"y", axis_json(report.map.y, report.y_unit)},
                     {"methods", report.map.methods},
                     {"known", report.map.known()},
                     {"points", points},
                     {"status", to_string(ended)}};
  return json_document("map", provenance, json_text(body));
}

std::string map_csv(const MapReport& report) {
  const HuntingMap& map = report.map;
  std::vector<std::string> heading{map.x.path, map.y.path, "happens", "cycles", "stable_cycles", "amplitude", "period"};
  for (const auto& method : map.methods)
    for (const auto* what : {"", " amplitude ratio", " frequency ratio"}) heading.push_back(method + what);
  std::string out = csv_line(heading);
  for (std::size_t k = 0; k < map.size(); ++k) {
    const auto& point = map.points[k];
    if (!point) continue;
    std::vector<std::string> row{
        shortest(map.x_of(k)),         shortest(map.y_of(k)),         point->in_words(),
        std::to_string(point->cycles), std::to_string(point->stable), shortest(point->amplitude),
        shortest(point->period)};
    for (const auto& at : point->methods)
      row.insert(row.end(), {std::string(to_string(at.worth)), shortest(at.amplitude), shortest(at.frequency)});
    out += csv_line(row);
  }
  return out;
}

}  // namespace limcycle
