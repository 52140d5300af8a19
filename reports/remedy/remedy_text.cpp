#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/remedy/costs.hpp"
#include "limcycle/reports/remedy/remedy.hpp"

namespace limcycle {
namespace {

/// True for a number in the unit of y.
bool is_of_output(const RemedyCandidate& candidate) { return candidate.measure == Measure::displacement; }

std::string number_of_remedy(const RemedyCandidate& candidate, double value, int digits, const Units& units) {
  if (is_of_output(candidate))
    return Units::attach(with_digits(value * units.y_per_si, units.y_per_si == 1.0 ? digits : digits + 2), units.y);
  return Units::attach(with_digits(value, digits), candidate.unit == "1" ? "" : candidate.unit);
}

/// "raise loop.plant.damping from 0 to 1.2 N s/m", "set loop.error.half_width to 0.07 m".
std::string in_words(const Remedy& remedy, const Units& units) {
  const RemedyCandidate& candidate = remedy.candidate;
  const std::string to = number_of_remedy(candidate, remedy.value, 4, units);
  if (candidate.is_absent()) return fmt::format("set {} to {}", candidate.parameter, to);
  return fmt::format("{} {} from {} to {}", std::abs(remedy.value) > std::abs(candidate.own) ? "raise" : "lower",
                     candidate.parameter, number_of_remedy(candidate, candidate.own, 4, units), to);
}

std::string without_cure(const RemedyReport& report) {
  std::string out;
  const auto list = [&](const std::string& heading, const auto& belongs) {
    std::string items;
    for (const Remedy& one : report.remedies)
      if (belongs(one)) items += item(one.candidate.name, 23, one.why);
    if (!items.empty()) out += "\n" + heading + "\n" + items;
  };
  const auto applies = [](const Remedy& one) { return one.candidate.why_not.empty(); };
  list("Not decided", [&](const Remedy& one) { return applies(one) && !one.ends; });
  list("Does not end it", [&](const Remedy& one) { return applies(one) && one.ends == false; });
  list("Not tried", [&](const Remedy& one) { return !applies(one); });
  return out;
}

}  // namespace

Table remedy_table(const RemedyReport& report, const Units& units) {
  Table table{{{"remedy", "", Align::left},
               {"number", "", Align::left},
               {"now", ""},
               {"ends at", ""},
               {"as far as", ""},
               {"best", "", Align::left}},
              {}};
  for (const Remedy& one : report.remedies) {
    if (one.ends != true) continue;
    const auto cell = [&](double value, int digits) { return number_of_remedy(one.candidate, value, digits, units); };
    table.rows.push_back({one.candidate.name, short_path(one.candidate.parameter),
                          one.candidate.is_absent() ? "-" : cell(one.candidate.own, 4), cell(one.value, 4),
                          one.again() ? cell(*one.again(), 4) : "-", one.best ? "*" : ""});
  }
  return table;
}

Table remedy_cost_table(const RemedyReport& report, const Units& units) {
  NamedCosts loops{{"(as it stands)", &report.now}};
  for (const Remedy& one : report.remedies)
    if (one.ends == true) loops.emplace_back(one.candidate.name, &one.costs);
  return cost_table("remedy", loops, units);
}

std::string remedy_answer(const RemedyReport& report, const Units& units) {
  const std::string cut = report.status == Status::interrupted ? "Interrupted; partial result: " : "";
  switch (report.hunts) {
    case Hunts::undecided:
      return cut + "Whether this loop hunts was not decided: " + report.why + ".";
    case Hunts::no:
      return cut + "This loop does not hunt from any start that was tried: it needs no remedy.";
    case Hunts::diverges:
      return cut + "This loop does not hunt, but its motion grows without bound (" + report.why +
             "): remedies against hunting do not end that.";
    case Hunts::neutral:
      return cut + "This loop oscillates for ever with any amplitude that it is given (" + report.why +
             "): nothing feeds the oscillation, and damping of any size ends it.";
    case Hunts::yes:
      break;
  }
  std::string out = cut + "This loop hunts. " + report.cause.why;
  const auto first = std::ranges::find_if(report.remedies, [](const Remedy& one) { return one.ends == true; });
  if (first == report.remedies.end()) {
    const bool open = std::ranges::any_of(report.remedies,
                                          [](const Remedy& one) { return !one.ends && one.candidate.why_not.empty(); });
    return out +
           (open ? " No remedy was found that certainly ends it." : " None of the remedies that were tried ends it.");
  }
  const auto count = std::ranges::count_if(report.remedies, [](const Remedy& one) { return one.ends == true; });
  out += count == 1 ? " One remedy ends it: " : fmt::format(" {} remedies end it; the first: ", count);
  return out + in_words(*first, units) + " (" + first->candidate.name + ").";
}

Document remedy_document(const std::string& title, const RemedyReport& report, const Units& units) {
  Document out(wrapped(title) + "\n" + wrapped(remedy_answer(report, units)));
  const Table table = remedy_table(report, units);
  if (!table.rows.empty()) {
    out.add("What ends it", table);
    out += wrapped(
        "*: no other remedy is at least as good in every cost (an unknown one counts as the worst) and better in one. "
        "Each value is the one "
        "nearest to the present at which the loop does not hunt, confirmed by simulations on both sides of the "
        "edge: choose a value well beyond it.");
    out.add("What it costs there", remedy_cost_table(report, units));
    out += wrapped(cost_legend(report.step, units));
  }
  out += without_cure(report) + notes_text(report.notes);
  if (report.status != Status::converged) out += fmt::format("\nStatus: {}\n", to_string(report.status));
  return out;
}

std::string remedy_text(const std::string& title, const RemedyReport& report, const Units& units) {
  return remedy_document(title, report, units).text();
}

}  // namespace limcycle
