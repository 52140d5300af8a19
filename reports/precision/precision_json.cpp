#include <cmath>

#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/precision/precision.hpp"

namespace limcycle {
namespace {

Json point_json(const WorkPoint& point) {
  return {{"method", point.method},
          {"setting", point.setting},
          {"error", number(point.error)},
          {"state_error", number(point.state_error)},
          {"seconds", number(point.seconds)},
          {"evaluations", point.evaluations},
          {"unit", point.unit},
          {"status", to_string(point.quality)},
          {"method_status", to_string(point.status)},
          {"why", point.why}};
}

Json reference_json(const WorkChart& chart, const CycleReference* cycle) {
  Json out = {{"question", chart.question},
              {"verified", chart.answered},
              {"made_by", chart.made_by},
              {"verified_by", chart.verified_by},
              {"agreement", number(chart.agreement)},
              {"error", number(chart.floor)},
              {"why", chart.why}};
  if (cycle == nullptr) return out;
  out["period"] = number(cycle->cycle.period);
  out["amplitude"] = number(cycle->cycle.amplitude);
  out["independent"] = cycle->independent;
  return out;
}

void add_chart(Json& top, const WorkChart& chart, const CycleReference* cycle) {
  top["reference"].push_back(reference_json(chart, cycle));
  const std::size_t first = top["points"].size();
  for (const auto& point : chart.points) {
    Json one = {{"question", chart.question}};
    one.update(point_json(point));
    top["points"].push_back(std::move(one));
  }
  for (const std::size_t i : chart.front) top["front"].push_back(first + i);
  for (const auto& method : chart.never_best)
    top["never_best"].push_back({{"question", chart.question}, {"method", method}});
}

std::string row(const std::string& question, double sigma0, const WorkPoint& point, bool front) {
  return csv_line({question, shortest(sigma0), point.method, point.setting, shortest(point.error),
                   shortest(point.state_error), shortest(point.seconds), std::to_string(point.evaluations), point.unit,
                   std::string(to_string(point.quality)), std::string(to_string(point.status)),
                   front ? "true" : "false", point.why});
}

}  // namespace

std::string precision_json(const Provenance& provenance, const PrecisionReport& report) {
  Json top;
  for (const char* list : {"reference", "points", "front", "never_best", "stiffness"}) top[list] = Json::array();
  if (report.cycle_chart) add_chart(top, *report.cycle_chart, report.cycle ? &*report.cycle : nullptr);
  if (report.df_chart) add_chart(top, *report.df_chart, nullptr);
  for (const auto& point : report.stiffness.points) {
    Json one = {{"sigma0", number(point.sigma0)}, {"period", number(point.period)}};
    one.update(point_json(point.result));
    top["stiffness"].push_back(std::move(one));
  }
  top["df_points"] = Json::array();
  for (const auto& point : report.df_points)
    top["df_points"].push_back({{"amplitude", point.amplitude}, {"frequency", point.frequency}, {"bias", point.bias}});
  top["right_within"] = right_within;
  top["notes"] = report.notes;
  for (const auto& note : report.stiffness.notes) top["notes"].push_back(note);
  top["status"] = to_string(report.status);
  return json_document("precision", provenance, json_text(top));
}

std::string precision_csv(const PrecisionReport& report) {
  std::string out = csv_line({"question", "sigma0", "method", "setting", "error", "state_error", "seconds",
                              "evaluations", "unit", "status", "method_status", "front", "why"});
  for (const auto* chart : {&report.cycle_chart, &report.df_chart}) {
    if (!*chart) continue;
    for (std::size_t i = 0; i < (*chart)->points.size(); ++i)
      out += row((*chart)->question, not_known, (*chart)->points[i],
                 std::ranges::find((*chart)->front, i) != (*chart)->front.end());
  }
  for (const auto& point : report.stiffness.points) out += row("stiffness", point.sigma0, point.result, false);
  return out;
}

}  // namespace limcycle
