#include <cmath>

#include "limcycle/reports/continuation/margin.hpp"
#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

Json side_json(const MarginSide& side, double own) {
  const bool found = side.found();
  return {{"hunting", to_string(side.what)},
          {"value", found ? number(side.value) : Json(nullptr)},
          {"change_percent", found ? number(100.0 * (side.value / own - 1.0)) : Json(nullptr)},
          {"error", found ? number(side.error) : Json(nullptr)},
          {"why", side.why}};
}

Json parameter_json(const ParameterMargin& one) {
  const double distance = one.distance();
  return {{"name", one.parameter.path},
          {"unit", one.parameter.unit},
          {"value", number(one.parameter.value)},
          {"part", one.parameter.friction ? "friction" : "plant or controller"},
          {"distance_percent", number(100.0 * distance)},
          {"nearest", one.nearest() ? number(one.nearest()->value) : Json(nullptr)},
          {"up", side_json(one.up, one.parameter.value)},
          {"down", side_json(one.down, one.parameter.value)}};
}

}  // namespace

std::string margin_json(const Provenance& provenance, const MarginReport& report) {
  Json top;
  top["hunts"] = report.hunts;
  top["factor"] = report.factor;
  top["cycles"] = Json::array();
  for (const auto& cycle : report.cycles)
    top["cycles"].push_back({{"amplitude", number(cycle.amplitude)},
                             {"period", number(cycle.period)},
                             {"stable", cycle.stable ? Json(*cycle.stable) : Json(nullptr)}});
  top["parameters"] = Json::array();
  for (const auto& one : report.parameters) top["parameters"].push_back(parameter_json(one));
  top["describing_function"] = nullptr;
  if (report.balance)
    top["describing_function"] = {{"distance_percent", number(100.0 * report.balance->distance)},
                                  {"amplitude", number(report.balance->amplitude)},
                                  {"frequency", number(report.balance->frequency)}};
  top["notes"] = report.notes;
  if (!report.refused.empty()) top["notes"].push_back(report.refused);
  top["status"] = to_string(report.status);
  return json_document("margin", provenance, json_text(top));
}

std::string margin_csv(const MarginReport& report) {
  std::string out =
      csv_line({"name", "unit", "own_value", "part", "side", "hunting", "value", "change_percent", "error", "why"});
  for (const auto& one : report.parameters)
    for (const auto* side : {&one.up, &one.down}) {
      const bool found = side->found();
      out += csv_line({one.parameter.path, one.parameter.unit, shortest(one.parameter.value),
                       one.parameter.friction ? "friction" : "plant or controller", side == &one.up ? "up" : "down",
                       std::string(to_string(side->what)), found ? shortest(side->value) : "",
                       found ? shortest(100.0 * (side->value / one.parameter.value - 1.0)) : "",
                       found ? shortest(side->error) : "", side->why});
    }
  return out;
}

}  // namespace limcycle
