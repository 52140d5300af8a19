#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/remedy/costs.hpp"
#include "limcycle/reports/tune/tune.hpp"
#include "limcycle/reports/words.hpp"

namespace limcycle {
namespace {

std::string aside_in_words(const TuneReport& report) { return with_digits(100.0 * report.aside, 1) + " %"; }

std::string point_in_words(const TuneReport& report, const TunePoint& point) {
  const auto names = tune_names(report);
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string& unit = report.numbers[i].unit;
    parts.push_back(names[i] + " = " + Units::attach(shortest(point.values[i]), unit == "1" ? "" : unit));
  }
  return listed_in_words(parts);
}

/// What stops the result from being better: edges next to it, and bounds on which it lies.
std::string edges_in_words(const TuneReport& report) {
  const auto names = tune_names(report);
  const auto& values = report.points[*report.best].values;
  std::map<TuneOutcome, std::vector<std::string>> changes;
  std::vector<std::string> bounds;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const TuneNumber& number = report.numbers[i];
    if (values[i] == number.low) bounds.push_back(names[i] + " on its lower bound");
    if (values[i] == number.high) bounds.push_back(names[i] + " on its upper bound");
    if (report.surroundings.empty()) continue;
    const std::string by = values[i] == 0.0 ? " 1 % of its range " : " " + aside_in_words(report) + " ";
    const auto& [below, above] = report.surroundings[i];
    if (below && *below != TuneOutcome::feasible) changes[*below].push_back(names[i] + by + "lower");
    if (above && *above != TuneOutcome::feasible) changes[*above].push_back(names[i] + by + "higher");
  }
  std::string out;
  const auto say = [&](TuneOutcome outcome, const std::string& lies, const std::string& consequence) {
    const auto found = changes.find(outcome);
    if (found != changes.end())
      out += fmt::format(" It lies {}: with {} {}.", lies, listed_in_words(found->second, "or"), consequence);
  };
  say(TuneOutcome::hunts, "at the edge of hunting",
      "the loop hunts; `limcycle margin` shows how far each number may change");
  if (report.margin == 0.0 && changes.contains(TuneOutcome::hunts))
    out += " `--margin 5` looks for numbers each of which may change by 5 %.";
  say(TuneOutcome::neutral, "at the edge of a motion that never dies out", "the loop oscillates for ever");
  say(TuneOutcome::diverges, "at the edge of divergence", "the loop diverges");
  say(TuneOutcome::unstable, "at the edge of stability", "the loop without friction is unstable");
  say(TuneOutcome::above_limit, "at a limit of the costs", "a limit is exceeded");
  say(TuneOutcome::undecided, "beside points that were not decided", "it is not known whether the loop hunts");
  say(TuneOutcome::invalid, "at a rule of the loop", "the numbers are not valid");
  if (!bounds.empty())
    out += fmt::format(" It has {}: beyond {} there may be better points.", listed_in_words(bounds),
                       bounds.size() == 1 ? "it" : "them");
  return out;
}

std::string agreement_in_words(const TuneReport& report, const Units& units) {
  std::vector<std::string> costs;  // at the ends of those that converged
  std::size_t cut = 0;
  for (const TuneSearch& one : report.searches)
    if (!one.ended)
      ++cut;
    else if (report.points[one.to].outcome == TuneOutcome::feasible)
      costs.push_back(
          tune_cost_in_words(*report.points[one.to].costs[static_cast<std::size_t>(report.minimised)], report, units));
  std::string out;
  switch (report.agreement) {
    case TuneAgreement::none:
      break;
    case TuneAgreement::single:
      out = " One local search converged, so other optima are possible.";
      break;
    case TuneAgreement::same_point:
      out = fmt::format(" {} local searches converged, all to this optimum.", costs.size());
      break;
    case TuneAgreement::same_cost:
      out = fmt::format(
          " {} local searches converged to different points with the same cost within 1 %: the optimum is flat, or "
          "there are several.",
          costs.size());
      break;
    case TuneAgreement::local_optima:
      out = fmt::format(" {} local searches converged, to {}: there are local optima, and a better point may exist.",
                        costs.size(), listed_in_words(costs));
  }
  if (cut > 0 && report.status != Status::interrupted)
    out += fmt::format(" {} reached {} limit of judgements and did not converge.",
                       cut == 1 ? "One" : std::to_string(cut), cut == 1 ? "its" : "their");
  return out;
}

std::string as_it_stands(const TuneReport& report, const Units& units) {
  const std::string now =
      report.cost_now ? fmt::format(" (as it stands {})", tune_cost_in_words(*report.cost_now, report, units)) : "";
  switch (report.hunts) {
    case Hunts::yes:
      return now + ". As it stands the loop hunts.";
    case Hunts::no:
      return now + ". As it stands the loop does not hunt either.";
    case Hunts::neutral:
      return now + ". As it stands the loop oscillates for ever with any amplitude.";
    case Hunts::diverges:
      return now + ". As it stands the loop diverges.";
    case Hunts::undecided:
      break;
  }
  return now + ". Whether the loop hunts as it stands was not decided.";
}

std::string nothing_found(const TuneReport& report) {
  std::string counts;
  for (const auto& row : tune_outcome_table(report).rows)
    counts += (counts.empty() ? "" : ", ") + row[0] + ": " + row[1];
  const bool limits = std::ranges::any_of(report.limits, [](const auto& limit) { return limit.has_value(); });
  return fmt::format(
      "No point without hunting was found within these bounds{}. {} points were tried ({}). That is no proof that "
      "there "
      "is none: more --samples look closer, wider bounds farther, and `limcycle remedy` tries other changes.",
      limits ? " and limits" : "", report.points.size(), counts);
}

}  // namespace

std::string tune_cost_name(TuneCost cost) {
  constexpr std::string_view names[] = {"peak sensitivity Ms", "settling time", "integral of the squared error"};
  return std::string(names[static_cast<std::size_t>(cost)]);
}

std::string outcome_in_words(TuneOutcome outcome) {
  switch (outcome) {
    case TuneOutcome::feasible:
      return "does not hunt";
    case TuneOutcome::hunts:
      return "hunts";
    case TuneOutcome::neutral:
      return "oscillates for ever";
    case TuneOutcome::diverges:
      return "diverges";
    case TuneOutcome::undecided:
      return "undecided";
    case TuneOutcome::fragile:
      return "hunts within the margin";
    case TuneOutcome::unstable:
      return "linear loop unstable";
    case TuneOutcome::above_limit:
      return "above a limit";
    case TuneOutcome::invalid:
      return "not valid";
    case TuneOutcome::not_judged:
      break;
  }
  return "not judged";
}

std::vector<std::string> tune_names(const TuneReport& report) {
  const auto last = [](const TuneNumber& one) { return one.path.substr(one.path.rfind('.') + 1); };
  std::vector<std::string> names;
  for (const TuneNumber& one : report.numbers)
    names.push_back(std::ranges::count(report.numbers, last(one), last) == 1 ? last(one) : short_path(one.path));
  return names;
}

std::string tune_cost_in_words(double cost, const TuneReport& report, const Units& units) {
  switch (report.minimised) {
    case TuneCost::settling:
      return with_digits(cost, 4) + " s";
    case TuneCost::ise:
      return with_digits(cost * units.y_per_si * units.y_per_si, 4) + (units.y.empty() ? " s" : " " + units.y + "^2 s");
    case TuneCost::ms:
      break;
  }
  return with_digits(cost, 4);
}

Table tune_number_table(const TuneReport& report) {
  Table table{{{"number", "", Align::left},
               {"unit", "", Align::left},
               {"from", ""},
               {"to", ""},
               {"now", ""},
               {"tuned", ""},
               {aside_in_words(report) + " lower", "", Align::left},
               {aside_in_words(report) + " higher", "", Align::left}},
              {}};
  for (std::size_t i = 0; i < report.numbers.size(); ++i) {
    const TuneNumber& one = report.numbers[i];
    const auto side = [&](std::optional<TuneOutcome> TuneSurroundings::*which, double bound) -> std::string {
      if (!report.best) return "-";
      if (report.points[*report.best].values[i] == bound) return "bound";
      if (report.surroundings.empty() || !(report.surroundings[i].*which)) return "-";
      return outcome_in_words(*(report.surroundings[i].*which));
    };
    table.rows.push_back({short_path(one.path), one.unit == "1" ? "" : one.unit, shortest(one.low), shortest(one.high),
                          std::isfinite(one.own) ? with_digits(one.own, 4) : "none",
                          report.best ? shortest(report.points[*report.best].values[i]) : "-",
                          side(&TuneSurroundings::below, one.low), side(&TuneSurroundings::above, one.high)});
  }
  return table;
}

Table tune_cost_table(const TuneReport& report, const Units& units) {
  return cost_table("loop", {{"(as it stands)", &report.now}, {"tuned", &report.costs}}, units);
}

Table tune_search_table(const TuneReport& report, const Units& units) {
  Table table{{{"search", ""}, {"from", ""}, {"to", ""}, {"judged", ""}, {"ends", "", Align::left}}, {}};
  for (const auto& name : tune_names(report)) table.columns.push_back({name, ""});
  std::size_t number = 1;
  for (const TuneSearch& one : report.searches) {
    const auto cost = [&](std::size_t point) {
      return tune_cost_in_words(*report.points[point].costs[static_cast<std::size_t>(report.minimised)], report, units);
    };
    const bool refuted = report.points[one.to].outcome != TuneOutcome::feasible;
    table.rows.push_back({std::to_string(number++), cost(one.from), cost(one.to), std::to_string(one.judged),
                          refuted     ? "refuted"
                          : one.ended ? "converged"
                                      : "cut short"});
    for (const double value : report.points[one.to].values) table.rows.back().push_back(shortest(value));
  }
  return table;
}

Table tune_outcome_table(const TuneReport& report) {
  Table table{{{"outcome", "", Align::left}, {"points", ""}}, {}};
  for (int kind = 0; kind <= static_cast<int>(TuneOutcome::not_judged); ++kind) {
    const auto outcome = static_cast<TuneOutcome>(kind);
    const auto count = std::ranges::count(report.points, outcome, [](const TunePoint& one) { return one.outcome; });
    if (count > 0) table.rows.push_back({outcome_in_words(outcome), std::to_string(count)});
  }
  return table;
}

std::string tune_answer(const TuneReport& report, const Units& units) {
  const std::string cut = report.status == Status::interrupted ? "Interrupted; partial result: " : "";
  if (!report.best) return cut + nothing_found(report);
  return cut +
         fmt::format("The least {} without hunting that was found is {}, with {}", tune_cost_name(report.minimised),
                     tune_cost_in_words(*report.best_cost(), report, units),
                     point_in_words(report, report.points[*report.best])) +
         as_it_stands(report, units) + edges_in_words(report) + agreement_in_words(report, units);
}

Document tune_document(const std::string& title, const TuneReport& report, const Units& units) {
  Document out(wrapped(title) + "\n" + wrapped(tune_answer(report, units)));
  out.add("The numbers", tune_number_table(report));
  if (report.best) {
    out.add("What the loop costs", tune_cost_table(report, units));
    out += wrapped(cost_legend(report.step, units));
    if (report.minimised == TuneCost::ise)
      out +=
          wrapped(fmt::format("The squared error is integrated over {} s after that step.", shortest(report.horizon)));
  }
  if (!report.searches.empty()) {
    out.add("The local searches", tune_search_table(report, units));
    out += wrapped(
        "from, to: cost where a search begins and ends; judged: points that were asked whether they hunt; refuted: "
        "its end did not stand the second judgement");
  }
  out.add("The points", tune_outcome_table(report));
  out += wrapped("not judged: allowed as far as it is known, but at a cost no better than that of others");
  out += notes_text(report.notes);
  if (report.status != Status::converged) out += fmt::format("\nStatus: {}\n", to_string(report.status));
  return out;
}

std::string tune_text(const std::string& title, const TuneReport& report, const Units& units) {
  return tune_document(title, report, units).text();
}

}  // namespace limcycle
