#include <cmath>

#include "limcycle/reports/adequacy/adequate.hpp"
#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

/// null: not requested, or no answer; an infinite error means another verdict, which is stated itself.
Json answer_json(const MethodAnswer& answer) {
  const bool cycle = answer.answered && answer.hunts();
  return {{"verdict", answer.answered ? Json(answer.verdict) : Json(nullptr)},
          {"period", cycle ? number(answer.period) : Json(nullptr)},
          {"amplitude", cycle ? number(answer.amplitude) : Json(nullptr)},
          {"first_harmonic", cycle && answer.first_harmonic > 0.0 ? number(answer.first_harmonic) : Json(nullptr)},
          {"seconds", number(answer.seconds)}};
}

Json point_json(const AdequatePoint& point) {
  Json out = {{"law", point.law}, {"method", point.method}};
  out.update(answer_json(point.answer));
  out["error"] = number(point.error);
  out["worst"] = number(point.worst);
  out["worst_at"] = point.worst_at;
  out["within"] = point.within;
  out["why"] = point.why;
  return out;
}

}  // namespace

std::string adequate_json(const Provenance& provenance, const AdequateReport& report) {
  Json top;
  top["tolerance"] = report.tolerance;
  top["best"] = answer_json(report.best);
  top["best"]["verified"] = report.verified;
  top["law"] = report.least ? Json(report.laws[*report.least].name) : Json(nullptr);
  top["method"] = report.cheapest ? Json(report.points[*report.cheapest].method) : Json(nullptr);
  top["laws"] = Json::array();
  for (const auto& law : report.laws)
    top["laws"].push_back({{"name", law.name},
                           {"kind", law.law ? Json(law.law->kind()) : Json(nullptr)},
                           {"possible", law.law.has_value()},
                           {"own", law.own},
                           {"rule", law.rule}});
  top["points"] = Json::array();
  for (const auto& point : report.points) top["points"].push_back(point_json(point));
  top["spread"] = report.spread;
  top["spread_rule"] = report.spread_rule;
  top["notes"] = report.notes;
  top["why"] = report.why;
  top["status"] = to_string(report.status);
  return json_document("adequate", provenance, json_text(top));
}

std::string adequate_csv(const AdequateReport& report) {
  std::string out = csv_line(
      {"law", "method", "verdict", "period", "amplitude", "seconds", "error", "worst", "worst_at", "within", "why"});
  for (const auto& point : report.points) {
    const bool cycle = point.answer.answered && point.answer.hunts();
    out += csv_line({point.law, point.method, point.answer.answered ? point.answer.verdict : "",
                     cycle ? shortest(point.answer.period) : "", cycle ? shortest(point.answer.amplitude) : "",
                     shortest(point.answer.seconds), shortest(point.error), shortest(point.worst), point.worst_at,
                     point.within ? "true" : "false", point.why});
  }
  return out;
}

}  // namespace limcycle
