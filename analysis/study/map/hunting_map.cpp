#include "limcycle/analysis/study/map/hunting_map.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"
#include "limcycle/analysis/study/composite/composite_balance.hpp"
#include "limcycle/analysis/study/predict/method_names.hpp"
#include "limcycle/analysis/study/predict/verdicts.hpp"

namespace limcycle {
namespace {

constexpr Outcome every_outcome[] = {Outcome::rest,      Outcome::sliding,    Outcome::cycle,    Outcome::family,
                                     Outcome::irregular, Outcome::divergence, Outcome::undecided};
constexpr std::size_t of_point = 5, of_method = 3;  // columns of a row

bool applies(const std::string& method, const Loop& loop) {
  if (method == composite_name) return loop.delay == 0.0 && !CompositeBalance::not_applicable(loop);
  if (method == df_name) return !FirstHarmonicBalance::not_applicable(loop);
  return true;
}

Worth worth_of(const std::string& method, const PredictReport& report) {
  const auto verdict = [&](Verdict kind) {
    return std::ranges::any_of(report.predictions,
                               [&](const Prediction& p) { return p.method == method && p.verdict == kind; });
  };
  if (verdict(Verdict::wrong)) return Worth::wrong;
  if (std::ranges::any_of(report.missed, [&](const Missed& m) { return m.method == method; }))
    return searched_completely(report, method) ? Worth::missed : Worth::undecided;
  if (verdict(Verdict::biased)) return Worth::biased;
  if (verdict(Verdict::undecided)) return Worth::undecided;
  // Predicting nothing is right only if it is known that nothing oscillates.
  const auto irregular = [](const OutcomeOfStart& one) { return one.outcome == Outcome::irregular; };
  if (!verdict(Verdict::confirmed) && std::ranges::any_of(report.outcomes, irregular))
    return searched_completely(report, method) ? Worth::missed : Worth::undecided;
  const auto undecided = [](const OutcomeOfStart& one) { return one.outcome == Outcome::undecided; };
  const bool known = verdict(Verdict::confirmed) || std::ranges::none_of(report.outcomes, undecided);
  return known ? Worth::right : Worth::undecided;
}

MapPoint seen(const PredictReport& report) {
  MapPoint point;
  for (const Outcome outcome : every_outcome)
    if (std::ranges::any_of(report.outcomes, [&](const OutcomeOfStart& one) { return one.outcome == outcome; }))
      point.outcomes.push_back(outcome);
  point.cycles = static_cast<int>(report.cycles.size());
  for (const Cycle& cycle : report.cycles) {
    if (cycle.stable != true) continue;
    ++point.stable;
    if (cycle.amplitude <= point.amplitude) continue;
    point.amplitude = cycle.amplitude;
    point.period = cycle.period;
  }
  return point;
}

}  // namespace

MethodAtPoint method_at(const std::string& method, const PredictReport& report) {
  MethodAtPoint at{worth_of(method, report)};
  double nearest = infinite;
  for (const Prediction& p : report.predictions) {
    if (p.method != method || !p.cycle) continue;
    const Cycle& cycle = report.cycles[*p.cycle];
    const double amplitude = p.amplitude / cycle.first_harmonic, frequency = p.frequency / cycle.frequency();
    const double distance = std::abs(std::log(amplitude)) + std::abs(std::log(frequency));
    if (!(distance < nearest)) continue;
    nearest = distance;
    at.amplitude = amplitude;
    at.frequency = frequency;
  }
  return at;
}

std::string_view to_string(Worth worth) {
  constexpr std::string_view names[] = {"right", "biased", "missed", "false", "undecided", "not applicable"};
  return names[static_cast<std::size_t>(worth)];
}

double MapAxis::value(int i) const {
  if (i < 0 || i >= points) throw std::out_of_range("a map has no such point");
  if (i == 0) return from;
  if (i == points - 1) return to;
  const double share = static_cast<double>(i) / (points - 1);
  return logarithmic ? from * std::pow(to / from, share) : from + share * (to - from);
}

bool MapPoint::has(Outcome outcome) const { return std::ranges::find(outcomes, outcome) != outcomes.end(); }

std::string MapPoint::in_words() const {
  if (outcomes.empty()) return "not valid";
  std::string words;
  for (const Outcome outcome : outcomes) {
    if (outcome == Outcome::undecided && outcomes.size() > 1) continue;
    words += (words.empty() ? "" : " or ") +
             std::string(outcome == Outcome::cycle ? std::string_view("hunting") : to_string(outcome));
  }
  return words;
}

std::size_t HuntingMap::known() const {
  return static_cast<std::size_t>(std::ranges::count_if(points, [](const auto& point) { return point.has_value(); }));
}

std::vector<std::string> names_of(const Methods& wanted) {
  std::vector<std::string> names;
  if (wanted.describing_function) names.emplace_back(df_name);
  if (wanted.composite) names.emplace_back(composite_name);
  if (wanted.harmonic_balance) names.emplace_back(balance_name);
  return names;
}

MapPoint map_point(const Loop& loop, const PredictOptions& options) {
  PredictOptions here = options;
  const auto methods = names_of(options.methods);
  MapPoint point;
  try {
    const PredictReport report = predict(loop, here);
    point = seen(report);
    for (const auto& method : methods)
      point.methods.push_back(applies(method, loop) ? method_at(method, report) : MethodAtPoint{});
  } catch (const std::invalid_argument&) {  // a method rejects the loop
    point.methods.assign(methods.size(), {Worth::undecided});
  }
  if (point.outcomes.empty()) point.outcomes.push_back(Outcome::undecided);
  return point;
}

std::vector<std::string> map_columns(const std::vector<std::string>& methods) {
  std::vector<std::string> columns{"outcomes", "cycles", "stable_cycles", "amplitude", "period"};
  for (const auto& method : methods)
    for (const auto* what : {"", " amplitude", " frequency"}) columns.push_back(method + what);
  return columns;
}

std::vector<double> to_row(const MapPoint& point) {
  unsigned bits = 0;
  for (const Outcome outcome : point.outcomes) bits |= 1U << static_cast<unsigned>(outcome);
  std::vector<double> row{static_cast<double>(bits), static_cast<double>(point.cycles),
                          static_cast<double>(point.stable), point.amplitude, point.period};
  for (const auto& at : point.methods)
    row.insert(row.end(), {static_cast<double>(at.worth), at.amplitude, at.frequency});
  return row;
}

MapPoint point_of_row(std::span<const double> row, std::size_t methods) {
  if (row.size() != of_point + of_method * methods) throw std::invalid_argument("a row of a map has another length");
  const auto whole = [](double value, double most) {
    if (!(value >= 0.0 && value <= most && value == std::floor(value)))
      throw std::invalid_argument("a row of a map holds an impossible number");
    return static_cast<unsigned>(value);
  };
  MapPoint point;
  const unsigned bits = whole(row[0], 127.0);
  for (const Outcome outcome : every_outcome)
    if ((bits >> static_cast<unsigned>(outcome) & 1U) != 0) point.outcomes.push_back(outcome);
  point.cycles = static_cast<int>(whole(row[1], 1e6));
  point.stable = static_cast<int>(whole(row[2], 1e6));
  point.amplitude = row[3];
  point.period = row[4];
  for (std::size_t m = 0; m < methods; ++m) {
    const auto at = row.subspan(of_point + of_method * m, of_method);
    point.methods.push_back({static_cast<Worth>(whole(at[0], 5.0)), at[1], at[2]});
  }
  return point;
}

}  // namespace limcycle
