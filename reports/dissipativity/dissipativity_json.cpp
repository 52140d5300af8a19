#include <algorithm>
#include <cmath>

#include "limcycle/reports/dissipativity/dissipativity.hpp"
#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

Json decision(Decision decision) {
  if (decision == Decision::yes || decision == Decision::no) return decision == Decision::yes;
  return std::string(to_string(decision));
}

Json answer(const Answer& answer) { return {{"answer", decision(answer.decision)}, {"why", answer.why}}; }

Json passive(Passive passive) {
  if (passive == Passive::undecided) return "undecided";
  return passive == Passive::yes;
}

/// Proved bounds of the states; null if there is none.
Json state_bound(const DissipativityReport& report) {
  if (!report.over_all || report.over_all->states.empty()) return nullptr;
  Json list = Json::array();
  bool any = false;
  for (const auto& bound : report.over_all->states) {
    const double size = std::max(std::abs(bound.low), std::abs(bound.high));
    const bool proved = bound.kind != BoundKind::searched && std::isfinite(size);
    any = any || proved;
    list.push_back(proved ? Json(size) : Json(nullptr));
  }
  return any ? list : Json(nullptr);
}

Json state_bounds(const DissipativityReport& report) {
  Json list = Json::array();
  if (!report.over_all) return list;
  for (std::size_t i = 0; i < report.over_all->states.size(); ++i) {
    const auto& bound = report.over_all->states[i];
    list.push_back({{"state", i < report.states.size() ? report.states[i] : "z"},
                    {"low", number(bound.low)},
                    {"high", number(bound.high)},
                    {"known", to_string(bound.kind)}});
  }
  return list;
}

Json force_bound(const DissipativityReport& report) {
  if (!report.up_to_speed) return nullptr;
  const ForceBound& force = report.up_to_speed->force;
  return {{"value", number(force.value)},
          {"up_to_speed", number(force.up_to_speed)},
          {"known", to_string(force.kind)},
          {"seen", number(report.up_to_speed->seen.force)}};
}

Json counterexample(const std::optional<Counterexample>& found) {
  if (!found) return nullptr;
  return {{"time", numbers(found->input.time)},
          {"velocity", numbers(found->input.velocity)},
          {"period", number(found->input.period())},
          {"initial", numbers(found->z0)},
          {"energy_per_cycle", number(found->energy)},
          {"error", number(found->error)},
          {"confirmed_energy_per_cycle", number(found->confirmed)},
          {"taken_from_rest", numbers(found->taken)},
          {"words", found->words}};
}

Json complex_list(const Eigen::VectorXcd& values) {
  Json list = Json::array();
  for (const auto& value : values) list.push_back({number(value.real()), number(value.imag())});
  return list;
}

Json extent(const Extent& extent) { return {number(extent.low), number(extent.high)}; }

/// An empty set has no dimension, and no extent.
Json stuck(const StuckSet& stuck) {
  const bool exists = stuck.dimension >= 0;
  return {{"exists", answer(stuck.answer)},
          {"dimension", exists ? Json(stuck.dimension) : Json(nullptr)},
          {"force", exists ? extent(stuck.force) : Json(nullptr)},
          {"output", exists ? extent(stuck.output) : Json(nullptr)},
          {"attracts", answer(stuck.attracts)},
          {"eigenvalues", complex_list(stuck.eigenvalues)},
          {"marches", {{"tried", stuck.tried}, {"returned", stuck.returned}}}};
}

Json sliding(const DissipativityReport& report) {
  const SlidingStability& sliding = report.loop->sliding;
  const bool slides = sliding.stable.decision != Decision::not_applicable;
  Json changes = Json::array();
  for (const auto& point : report.sliding_changes)
    changes.push_back(
        {{"speed", number(point.speed)}, {"frequency", number(point.frequency)}, {"stable_above", point.stable_above}});
  return {{"stable", answer(sliding.stable)},
          {"velocity", slides ? number(sliding.velocity) : Json(nullptr)},
          {"force", slides ? number(sliding.force) : Json(nullptr)},
          {"eigenvalues", complex_list(sliding.eigenvalues)},
          {"parameter", report.speed_of_sliding.empty() ? Json(nullptr) : Json(report.speed_of_sliding)},
          {"changes", changes}};
}

Json loop_json(const DissipativityReport& report) {
  if (!report.loop) return nullptr;
  const LoopDissipation& loop = *report.loop;
  Json margin = nullptr;
  if (loop.impedance.applies().decision == Decision::yes) {
    const auto least = loop.impedance.margin();
    margin = {{"least_resistance", number(least.value)}, {"frequency", number(least.frequency)}};
  }
  Json sector = nullptr;
  if (loop.sector.applies().decision == Decision::yes)
    sector = {{"slopes", {number(loop.sector.alpha()), number(loop.sector.beta())}},
              {"circle", answer(loop.sector.circle())},
              {"popov", answer(loop.sector.popov())},
              {"multiplier", loop.sector.multiplier() ? number(*loop.sector.multiplier()) : Json(nullptr)}};
  return {{"no_cycle", answer(loop.no_cycle)},
          {"agrees_with_predict", report.agrees ? Json(*report.agrees) : Json(nullptr)},
          {"rest_is_passive", answer(loop.rest_is_passive)},
          {"passivity", answer(loop.passivity)},
          {"impedance", margin},
          {"sector", sector},
          {"stuck_states", stuck(loop.stuck)},
          {"sliding", sliding(report)}};
}

Json range_json(const DissipativityReport& report) {
  if (!report.range) return nullptr;
  Json changes = Json::array();
  for (const auto& change : report.range->changes)
    changes.push_back({{"value", number(change.value)},
                       {"error", number(change.error)},
                       {"below", passive(change.below)},
                       {"above", passive(change.above)}});
  return {{"parameter", report.path + "." + report.asked->key},
          {"from", number(report.asked->from)},
          {"to", number(report.asked->to)},
          {"at_from", passive(report.range->at_low)},
          {"at_to", passive(report.range->at_high)},
          {"changes", changes},
          {"status", to_string(report.range->status)}};
}

}  // namespace

std::string dissipativity_json(const Provenance& provenance, const DissipativityReport& report) {
  Json top;
  top["element"] = {{"path", report.path}, {"kind", report.kind}};
  top["state_bound"] = state_bound(report);
  top["state_bounds"] = state_bounds(report);
  top["force_bound"] = force_bound(report);
  top["passive"] = passive(report.passivity.passive);
  top["deficit"] = number(report.passivity.deficit);
  top["method"] = report.passivity.method;
  top["why"] = report.passivity.why;
  top["searched"] = number(report.passivity.searched);
  top["top_speed"] = number(report.top_speed);
  top["threshold"] = nullptr;
  if (report.threshold && std::isfinite(report.threshold->value))
    top["threshold"] = {{"parameter", report.path + ".sigma2"},
                        {"value", number(report.threshold->value)},
                        {"error", number(report.threshold->error)}};
  top["passive_up_to_speed"] =
      report.passive_speed ? std::isinf(report.passive_speed->value) ? Json("any") : number(report.passive_speed->value)
                           : Json(nullptr);
  top["changes"] = range_json(report);
  top["counterexample"] = counterexample(report.passivity.counterexample);
  top["loop"] = loop_json(report);
  top["notes"] = report.notes;
  top["status"] = to_string(report.status);
  return json_document("dissipativity", provenance, json_text(top));
}

std::string dissipativity_csv(const DissipativityReport& report) {
  std::string out = csv_line({"kind", "x", "y", "y2", "y3"});
  if (const auto& curve = report.passivity.storage)
    for (std::size_t i = 0; i < curve->z.size(); ++i)
      out += csv_line({"storage", shortest(curve->z[i]), shortest(curve->least[i]), shortest(curve->most[i]),
                       i < curve->available.size() ? shortest(curve->available[i]) : ""});
  if (const auto& found = report.passivity.counterexample) {
    for (std::size_t i = 0; i < found->input.time.size(); ++i)
      out += csv_line({"input", shortest(found->input.time[i]), shortest(found->input.velocity[i]), "", ""});
    for (std::size_t i = 0; i < found->taken.size(); ++i)
      out += csv_line({"taken", std::to_string(i + 1), shortest(found->taken[i]), "", ""});
  }
  return out;
}

}  // namespace limcycle
