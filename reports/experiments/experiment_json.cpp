#include <cmath>

#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/experiments/experiment.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

Json figure_json(const ExperimentFigure& figure) {
  Json panels = Json::array();
  for (const auto& panel : figure.panels) {
    Json curves = Json::array();
    for (const auto& curve : panel.curves)
      curves.push_back({{"name", curve.name}, {"x", numbers(curve.x)}, {"y", numbers(curve.y)}});
    panels.push_back({{"title", panel.title}, {"curves", std::move(curves)}});
  }
  return {{"id", figure.id},
          {"heading", figure.heading},
          {"x", figure.x},
          {"x_unit", figure.x_unit},
          {"y", figure.y},
          {"y_unit", figure.y_unit},
          {"panels", std::move(panels)}};
}

Json experiment_object(const Experiment& one) {
  Json quantities = Json::array(), rows = Json::array(), findings = Json::array(), claims = Json::array(),
       figures = Json::array();
  for (const auto& quantity : one.quantities)
    quantities.push_back({{"key", quantity.key}, {"heading", quantity.heading}, {"unit", quantity.unit}});
  for (const auto& row : one.rows) {
    Json line{{"law", row.law}, {"setting", row.setting}};
    for (std::size_t i = 0; i < one.quantities.size(); ++i)
      line[one.quantities[i].key] = i < row.values.size() ? number(row.values[i]) : Json(nullptr);
    rows.push_back(std::move(line));
  }
  for (const auto& finding : one.findings)
    findings.push_back({{"law", finding.law}, {"finding", finding.text}, {"status", to_string(finding.status)}});
  for (const auto& claim : one.claims)
    claims.push_back({{"statement", claim.statement},
                      {"source", claim.source},
                      {"outcome", to_string(claim.outcome)},
                      {"measure", claim.measure}});
  for (const auto& figure : one.figures) figures.push_back(figure_json(figure));
  return {{"name", one.name},
          {"title", one.title},
          {"document", one.document},
          {"input", one.input},
          {"quantities", std::move(quantities)},
          {"rows", std::move(rows)},
          {"findings", std::move(findings)},
          {"claims", std::move(claims)},
          {"notes", one.notes},
          {"status", to_string(one.status)},
          {"figures", std::move(figures)}};
}

}  // namespace

std::string experiment_list_json(const Provenance& provenance, const std::vector<ExperimentEntry>& entries) {
  Json top;
  top["experiments"] = Json::array();
  for (const auto& entry : entries) top["experiments"].push_back({{"name", entry.name}, {"title", entry.title}});
  top["status"] = to_string(Status::converged);
  return json_document("experiment", provenance, json_text(top));
}

std::string experiment_json(const Provenance& provenance, const std::vector<Experiment>& experiments, Status ended) {
  Json top;
  top["experiments"] = Json::array();
  for (const auto& one : experiments) top["experiments"].push_back(experiment_object(one));
  top["status"] = to_string(ended);
  return json_document("experiment", provenance, json_text(top));
}

std::string experiment_csv(const std::vector<Experiment>& experiments) {
  std::string out = csv_line({"kind", "experiment", "law", "setting", "quantity", "figure", "curve", "x", "y", "text"});
  for (const auto& one : experiments) {
    for (const auto& row : one.rows)
      for (std::size_t i = 0; i < one.quantities.size() && i < row.values.size(); ++i)
        out += csv_line(
            {"number", one.name, row.law, row.setting, one.quantities[i].key, "", "", "", shortest(row.values[i]), ""});
    for (const auto& finding : one.findings)
      out += csv_line({"finding", one.name, finding.law, "", "", "", "", "", "", finding.text});
    for (const auto& claim : one.claims)
      out += csv_line({"claim", one.name, "", std::string(to_string(claim.outcome)), "", "", "", "", "",
                       claim.statement + ": " + claim.measure});
    for (const auto& figure : one.figures)
      for (const auto& panel : figure.panels)
        for (const auto& curve : panel.curves)
          for (std::size_t i = 0; i < curve.x.size(); ++i)
            out += csv_line({"trace", one.name, panel.title, "", "", figure.id, curve.name, shortest(curve.x[i]),
                             shortest(curve.y[i]), ""});
  }
  return out;
}

}  // namespace limcycle
