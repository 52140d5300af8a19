#include <cmath>

#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/identify/identify.hpp"

namespace limcycle {
namespace {

Json end_json(const std::optional<double>& end) { return end ? number(*end) : Json(nullptr); }

std::string path_of(const std::string& name) { return "loop.friction." + name; }

Json parameter_json(const IdentifiedNumber& one) {
  return {{"name", path_of(one.name)},
          {"unit", one.unit},
          {"value", one.identifiable ? number(one.value) : Json(nullptr)},
          {"low", end_json(one.low)},
          {"high", end_json(one.high)},
          {"linear_low", end_json(one.linear_low)},
          {"linear_high", end_json(one.linear_high)},
          {"identifiable", one.identifiable}};
}

Json correlations_json(const IdentifiedLaw& law) {
  Json names = Json::array(), rows = Json::array();
  for (const auto& name : law.correlated) names.push_back(path_of(name));
  for (Eigen::Index i = 0; i < law.correlations.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index k = 0; k < law.correlations.cols(); ++k) row.push_back(number(law.correlations(i, k)));
    rows.push_back(std::move(row));
  }
  return {{"names", names}, {"matrix", rows}};
}

Json undetermined_json(const IdentifiedLaw& law) {
  Json list = Json::array();
  for (const auto& one : law.undetermined) {
    Json direction = Json::array();
    for (const auto& [name, weight] : one.direction)
      direction.push_back({{"name", path_of(name)}, {"weight", number(weight)}});
    list.push_back({{"direction", direction}, {"deviation", number(one.deviation)}});
  }
  return list;
}

Json law_json(const IdentifiedLaw& law) {
  Json parameters = Json::array(), records = Json::array();
  for (const auto& one : law.numbers) parameters.push_back(parameter_json(one));
  for (const auto& one : law.records)
    records.push_back({{"error", number(one.error)},
                       {"autocorrelation", number(one.whiteness.autocorrelation)},
                       {"white_probability", number(one.whiteness.probability)}});
  return {{"kind", law.law.kind()},
          {"fitted", law.fitted},
          {"start_states", law.start_states},
          {"bic", number(law.bic)},
          {"held_out", number(law.held_out)},
          {"parameters", parameters},
          {"correlations", correlations_json(law)},
          {"undetermined", undetermined_json(law)},
          {"records", records},
          {"march_error", number(law.march_error)},
          {"evaluations", law.evaluations},
          {"notes", law.notes},
          {"status", to_string(law.status)}};
}

Json plan_json(const IdentifiedLaw& law) {
  if (!law.plan) return nullptr;
  Json now = Json::array(), records = Json::array();
  for (std::size_t i = 0; i < law.numbers.size(); ++i)
    now.push_back({{"name", path_of(law.numbers[i].name)},
                   {"unit", law.numbers[i].unit},
                   {"value", number(law.plan->values[i])},
                   {"half_width", number(law.plan->half_width[i])}});
  for (const PlannedRecord& one : law.plan->records)
    records.push_back({{"kind", to_string(one.kind)}, {"rows", one.rows}, {"half_widths", numbers(one.half_width)}});
  return {
      {"noise", law.plan->noise}, {"noise_is_assumed", law.plan->noise_is_assumed}, {"now", now}, {"records", records}};
}

}  // namespace

std::string identify_json(const Provenance& provenance, const IdentifyReport& report) {
  Json top;
  top["laws"] = Json::array();
  for (const auto& law : report.laws) top["laws"].push_back(law_json(law));
  top["chosen"] = report.chosen ? Json(report.laws[*report.chosen].law.kind()) : Json(nullptr);
  top["records"] = Json::array();
  for (const auto& record : report.records)
    top["records"].push_back({{"file", record.name},
                              {"kind", to_string(record.kind)},
                              {"rows", record.compared.size()},
                              {"break_aways", record.break_aways.size()},
                              {"quantity", to_string(record.quantity)},
                              {"loss", record.huber ? "huber" : "squares"},
                              {"size", number(record.size)},
                              {"largest_force", record.motion ? Json(nullptr) : number(record.largest_force)},
                              {"notes", record.notes}});
  top["shooting"] = report.shooting ? Json(to_string(*report.shooting)) : Json(nullptr);
  top["plan"] = report.chosen ? plan_json(report.laws[*report.chosen]) : Json(nullptr);
  top["status"] = to_string(report.status);
  return json_document("identify", provenance, json_text(top));
}

std::string identify_csv(const IdentifyReport& report) {
  std::string out =
      csv_line({"law", "chosen", "bic", "held_out", "name", "unit", "value", "low", "high", "identifiable"});
  const auto end = [](const std::optional<double>& value) { return value ? shortest(*value) : std::string(); };
  for (std::size_t i = 0; i < report.laws.size(); ++i) {
    const auto& law = report.laws[i];
    for (const auto& one : law.numbers)
      out += csv_line({std::string(law.law.kind()), report.chosen == i ? "true" : "false", shortest(law.bic),
                       shortest(law.held_out), path_of(one.name), one.unit, one.identifiable ? shortest(one.value) : "",
                       end(one.low), end(one.high), one.identifiable ? "true" : "false"});
  }
  return out;
}

}  // namespace limcycle
