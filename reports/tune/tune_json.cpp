#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/remedy/costs.hpp"
#include "limcycle/reports/tune/tune.hpp"

namespace limcycle {
namespace {

Json known_number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json named(const TuneCosts& costs) {
  Json all = Json::object();
  for (std::size_t i = 0; i < costs.size(); ++i) all[std::string(tune_cost_names[i])] = known_number(costs[i]);
  return all;
}

Json side_json(const std::optional<TuneOutcome>& outcome) {
  return outcome ? Json(to_string(*outcome)) : Json(nullptr);
}

Json numbers_json(const TuneReport& report) {
  Json list = Json::array();
  for (std::size_t i = 0; i < report.numbers.size(); ++i) {
    const TuneNumber& one = report.numbers[i];
    const TuneSurroundings around = report.surroundings.empty() ? TuneSurroundings{} : report.surroundings[i];
    Json bound = nullptr, value = nullptr;
    if (report.best) {
      const double best = report.points[*report.best].values[i];
      value = number(best);
      if (best == one.low) bound = "lower";
      if (best == one.high) bound = "upper";
    }
    list.push_back({{"parameter", one.path},
                    {"unit", one.unit},
                    {"low", number(one.low)},
                    {"high", number(one.high)},
                    {"now", number(one.own)},
                    {"value", value},
                    {"on_bound", bound},
                    {"below", side_json(around.below)},
                    {"above", side_json(around.above)}});
  }
  return list;
}

Json point_json(const TunePoint& point) {
  return {{"values", numbers(point.values)},
          {"part", to_string(point.part)},
          {"search", point.part == TunePoint::Part::search ? Json(point.search) : Json(nullptr)},
          {"outcome", to_string(point.outcome)},
          {"ms", known_number(point.costs[0])},
          {"settling", known_number(point.costs[1])},
          {"ise", known_number(point.costs[2])},
          {"why", point.why}};
}

}  // namespace

std::string tune_json(const Provenance& provenance, const TuneReport& report) {
  Json top;
  top["minimise"] = to_string(report.minimised);
  top["at_most"] = named(report.limits);
  top["horizon"] = report.horizon > 0.0 ? number(report.horizon) : Json(nullptr);
  top["margin"] = number(report.margin);
  top["aside"] = number(report.aside);
  top["step"] = number(report.step);
  top["hunts"] = report.hunts == Hunts::undecided ? Json(nullptr) : Json(report.hunts == Hunts::yes);
  top["now"] = Json::parse(costs_json(report.now));
  top["cost_now"] = known_number(report.cost_now);
  top["best"] = or_null(report.best);
  top["cost"] = known_number(report.best_cost());
  top["cost_error"] = report.best ? number(report.cost_error) : Json(nullptr);
  top["costs"] = report.best ? Json::parse(costs_json(report.costs)) : Json(nullptr);
  top["numbers"] = numbers_json(report);
  top["agreement"] = to_string(report.agreement);
  top["searches"] = Json::array();
  for (const TuneSearch& one : report.searches)
    top["searches"].push_back({{"from", one.from}, {"to", one.to}, {"judged", one.judged}, {"converged", one.ended}});
  top["points"] = Json::array();
  for (const TunePoint& point : report.points) top["points"].push_back(point_json(point));
  top["notes"] = report.notes;
  top["status"] = to_string(report.status);
  return json_document("tune", provenance, json_text(top));
}

std::string tune_csv(const TuneReport& report) {
  std::vector<std::string> heading{"part", "search"};
  for (const TuneNumber& one : report.numbers) heading.push_back(one.path);
  for (const char* name : {"outcome", "ms", "settling", "ise", "best", "why"}) heading.emplace_back(name);
  std::string out = csv_line(heading);
  for (std::size_t i = 0; i < report.points.size(); ++i) {
    const TunePoint& point = report.points[i];
    std::vector<std::string> row{std::string(to_string(point.part)),
                                 point.part == TunePoint::Part::search ? std::to_string(point.search) : ""};
    for (const double value : point.values) row.push_back(shortest(value));
    row.emplace_back(to_string(point.outcome));
    for (const auto& cost : point.costs) row.push_back(cost ? shortest(*cost) : "");
    row.insert(row.end(), {report.best == i ? "yes" : "", point.why});
    out += csv_line(row);
  }
  return out;
}

}  // namespace limcycle
