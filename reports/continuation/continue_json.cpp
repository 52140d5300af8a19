#include <cmath>

#include "limcycle/reports/continuation/continue.hpp"
#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

Json point_json(std::size_t part, const BranchPoint& point) {
  const Cycle& cycle = point.cycle;
  Json multipliers = Json::array();
  for (const auto& value : cycle.multipliers)
    multipliers.push_back(Json::array({number(value.real()), number(value.imag())}));
  return {{"part", part},
          {"parameter", number(point.parameter)},
          {"amplitude", number(cycle.amplitude)},
          {"period", number(cycle.period)},
          {"stable", cycle.stable ? Json(*cycle.stable) : Json(nullptr)},
          {"multipliers", multipliers},
          {"first_harmonic", number(cycle.first_harmonic)},
          {"offset", number(cycle.offset)},
          {"sticking_fraction", number(cycle.sticking_fraction)},
          {"half_wave_symmetric", cycle.half_wave_symmetric},
          {"error", number(cycle.error)}};
}

Json event_json(std::size_t part, const BranchEvent& event) {
  return {{"part", part},
          {"type", to_string(event.type)},
          {"parameter", number(event.parameter)},
          {"period", number(event.period)},
          {"amplitude", number(event.amplitude)},
          {"error", number(event.error)},
          {"point", event.point},
          {"why", event.why}};
}

std::string cell(double value) { return shortest(value); }

const char* stable_cell(const std::optional<bool>& value) { return value ? (*value ? "true" : "false") : ""; }

}  // namespace

std::string continue_json(const Provenance& provenance, const ContinueReport& report) {
  Json top;
  top["parameter"] = {{"path", report.path},
                      {"unit", report.unit},
                      {"from", number(report.found.from)},
                      {"to", number(report.found.to)},
                      {"start", number(report.found.start)}};
  top["branch"] = Json::array();
  top["events"] = Json::array();
  for (std::size_t part = 0; part < report.found.branches.size(); ++part) {
    for (const auto& point : report.found.branches[part].points) top["branch"].push_back(point_json(part, point));
    for (const auto& event : report.found.branches[part].events) top["events"].push_back(event_json(part, event));
  }
  top["notes"] = report.found.notes;
  if (!report.found.refused.empty()) top["notes"].push_back(report.found.refused);
  top["status"] = to_string(report.found.status);
  return json_document("continue", provenance, json_text(top));
}

std::string continue_csv(const ContinueReport& report) {
  std::string out = csv_line({"kind", "part", "parameter", "amplitude", "period", "stable", "multiplier_re",
                              "multiplier_im", "first_harmonic", "offset", "sticking_fraction", "error", "why"});
  for (std::size_t part = 0; part < report.found.branches.size(); ++part) {
    for (const auto& [parameter, cycle] : report.found.branches[part].points) {
      const bool known = !cycle.multipliers.empty();
      out += csv_line({"point", std::to_string(part), cell(parameter), cell(cycle.amplitude), cell(cycle.period),
                       stable_cell(cycle.stable), known ? cell(cycle.multipliers.front().real()) : "",
                       known ? cell(cycle.multipliers.front().imag()) : "", cell(cycle.first_harmonic),
                       cell(cycle.offset), cell(cycle.sticking_fraction), cell(cycle.error), ""});
    }
    for (const auto& event : report.found.branches[part].events)
      out +=
          csv_line({std::string(to_string(event.type)), std::to_string(part), cell(event.parameter),
                    cell(event.amplitude), cell(event.period), "", "", "", "", "", "", cell(event.error), event.why});
  }
  return out;
}

}  // namespace limcycle
