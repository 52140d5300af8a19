#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/remedy/costs.hpp"
#include "limcycle/reports/remedy/remedy.hpp"

namespace limcycle {
namespace {

Json remedy_entry(const Remedy& remedy) {
  const RemedyCandidate& candidate = remedy.candidate;
  const bool applicable = candidate.why_not.empty();
  return {{"name", candidate.name},
          {"parameter", candidate.parameter.empty() ? Json(nullptr) : Json(candidate.parameter)},
          {"unit", applicable ? Json(candidate.unit) : Json(nullptr)},
          {"now", applicable ? number(candidate.own) : Json(nullptr)},
          {"value", remedy.ends == true ? number(remedy.value) : Json(nullptr)},
          {"ends", or_null(remedy.ends)},
          {"applicable", applicable},
          {"why", remedy.why},
          {"edges", numbers(remedy.edges)},
          {"beyond", numbers(remedy.beyond)},
          {"best", remedy.best},
          {"costs", Json::parse(costs_json(remedy.costs))}};
}

}  // namespace

std::string remedy_json(const Provenance& provenance, const RemedyReport& report) {
  Json top;
  top["hunts"] = report.hunts == Hunts::undecided ? Json(nullptr) : Json(report.hunts == Hunts::yes);
  top["cause"] = {{"kind", to_string(report.cause.kind)}, {"why", report.cause.why}, {"tests", Json::array()}};
  for (const Counterfactual& test : report.cause.tests)
    top["cause"]["tests"].push_back({{"without", test.without}, {"hunts", to_string(test.hunts)}});
  top["step"] = number(report.step);
  top["now"] = Json::parse(costs_json(report.now));
  top["remedies"] = Json::array();
  for (const Remedy& remedy : report.remedies) top["remedies"].push_back(remedy_entry(remedy));
  top["notes"] = report.notes;
  top["status"] = to_string(report.status);
  return json_document("remedy", provenance, json_text(top));
}

std::string remedy_csv(const RemedyReport& report) {
  std::string out = csv_line({"name", "parameter", "unit", "now", "applicable", "ends", "value", "again", "error_low",
                              "error_high", "settling_time", "overshoot", "phase_margin", "delay_margin",
                              "peak_sensitivity", "noise_gain", "actuator_travel", "robust_share", "why"});
  const auto cell = [](const std::optional<double>& value) { return value ? shortest(*value) : std::string(); };
  for (const Remedy& one : report.remedies) {
    const RemedyCosts& costs = one.costs;
    const auto& error = costs.steady_state_error;
    const bool applicable = one.candidate.why_not.empty();
    out += csv_line({one.candidate.name, one.candidate.parameter, one.candidate.unit,
                     applicable && std::isfinite(one.candidate.own) ? shortest(one.candidate.own) : "",
                     applicable ? "yes" : "no", one.ends ? (*one.ends ? "yes" : "no") : "",
                     one.ends == true ? shortest(one.value) : "", cell(one.again()), error ? shortest(error->low) : "",
                     error ? shortest(error->high) : "", cell(costs.settling_time), cell(costs.overshoot),
                     cell(costs.phase_margin), cell(costs.delay_margin), cell(costs.peak_sensitivity),
                     cell(costs.noise_gain), cell(costs.actuator_travel), cell(costs.robust_share), one.why});
  }
  return out;
}

}  // namespace limcycle
