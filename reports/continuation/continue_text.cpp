#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/continuation/continue.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

std::string unit_of(const ContinueReport& report) { return report.unit == "1" ? "" : report.unit; }

/// An event's parameter with its accurate digits; an end of the range is exact.
std::string event_place(const BranchEvent& event) {
  return std::isnan(event.error) ? with_digits(event.parameter, 4)
                                 : with_error(event.parameter, std::max(event.error, 0.6e-9));
}

std::size_t count(const ContinueReport& report, BranchEvent::Type type) {
  std::size_t n = 0;
  for (const auto& branch : report.found.branches)
    n += static_cast<std::size_t>(
        std::ranges::count(branch.events, type, [](const BranchEvent& event) { return event.type; }));
  return n;
}

/// Range of the parameter in which stable cycles of a branch exist.
struct Span {
  double low = infinite, high = -infinite;
  bool any() const { return low <= high; }
};
Span stable_span(const ContinueReport& report) {
  Span span;
  for (const auto& branch : report.found.branches)
    for (const auto& point : branch.points) {
      if (point.cycle.stable != true) continue;
      span.low = std::min(span.low, point.parameter);
      span.high = std::max(span.high, point.parameter);
    }
  return span;
}

std::string folds_in_words(const ContinueReport& report) {
  std::string out;
  for (const auto& branch : report.found.branches)
    for (const auto& event : branch.events) {
      if (event.type != BranchEvent::Type::fold) continue;
      out += (out.empty() ? "" : ", ") + Units::attach(event_place(event), unit_of(report));
    }
  return out;
}

Table branch_table(const Branch& branch, const ContinueReport& report, const Units& units) {
  const std::string name = report.path.substr(report.path.rfind('.') + 1);
  Table table{{{name, unit_of(report)},
               {"amplitude", units.y},
               {"period", "s"},
               {"stable", ""},
               {"largest mult.", ""},
               {"stuck", ""}},
              {}};
  const std::size_t n = branch.points.size();
  const std::size_t stride = (n + longest_branch_table - 1) / longest_branch_table;
  for (std::size_t i = 0; i < n; ++i) {
    const bool event = std::ranges::any_of(branch.events, [&](const auto& one) { return one.point == i; });
    if (i % stride != 0 && i + 1 != n && !event) continue;
    const auto& [parameter, cycle] = branch.points[i];
    const double error = std::max(cycle.error, 0.6e-6);
    table.rows.push_back({with_digits(parameter, 6), with_error(cycle.amplitude, error),
                          with_error(cycle.period, error), yes_or_no(cycle.stable),
                          cycle.multipliers.empty() ? "-" : with_digits(std::abs(cycle.multipliers.front()), 3),
                          as_percent(cycle.sticking_fraction)});
  }
  return table;
}

}  // namespace

Table event_table(const ContinueReport& report, const Units& units) {
  const std::string name = report.path.substr(report.path.rfind('.') + 1);
  Table table{
      {{"event", "", Align::left}, {name, unit_of(report)}, {"amplitude", units.y}, {"period", "s"}, {"error", ""}},
      {}};
  for (const auto& branch : report.found.branches)
    for (const auto& event : branch.events)
      table.rows.push_back({std::string(to_string(event.type)), event_place(event), with_digits(event.amplitude, 6),
                            with_digits(event.period, 6), as_error(event.error)});
  return table;
}

std::string continue_answer(const ContinueReport& report, const Units&) {
  const FollowReport& found = report.found;
  const std::string range = fmt::format("{} from {} to {}", report.path, with_digits(found.from, 4),
                                        Units::attach(with_digits(found.to, 4), unit_of(report)));
  std::string out;
  if (found.status == Status::interrupted) out = "Interrupted; partial result: ";
  if (!found.refused.empty())
    return out + "Not answered: " + found.refused + " over " + report.path +
           ". `limcycle map` answers over a plane of parameters.";
  if (found.branches.empty()) return out + (out.empty() ? "No" : "no") + " limit cycle was found for " + range + ".";
  const Span span = stable_span(report);
  if (span.any())
    out += fmt::format("Over {}, stable limit cycles were followed between {} and {}.", range, with_digits(span.low, 5),
                       Units::attach(with_digits(span.high, 5), unit_of(report)));
  else
    out += fmt::format("Over {}, only unstable limit cycles were followed.", range);
  const std::size_t folds = count(report, BranchEvent::Type::fold);
  if (folds > 0)
    out += fmt::format(" {} where the branch turns back: {}.", folds == 1 ? "There is one fold," : "There are folds",
                       folds_in_words(report));
  const std::size_t changes = count(report, BranchEvent::Type::stability);
  if (changes > 0)
    out +=
        fmt::format(" Stability changes {} away from folds.", changes == 1 ? "once" : fmt::format("{} times", changes));
  return out;
}

Document continue_document(const std::string& title, const ContinueReport& report, const Units& units) {
  Document out(wrapped(title) + "\n" + wrapped(continue_answer(report, units)));
  if (!report.found.branches.empty()) out.add("Events", event_table(report, units));
  std::size_t number = 0;
  for (const auto& branch : report.found.branches)
    for (const auto& event : branch.events)
      out += wrapped(fmt::format("{} at {}: {}.", to_string(event.type), event_place(event), event.why), 80, 2);
  for (const auto& branch : report.found.branches) {
    ++number;
    out += report.found.branches.size() == 1 ? "\nBranch\n" : fmt::format("\nBranch {}\n", number - 1);
    if (branch.points.size() > longest_branch_table)
      out += fmt::format("(some of {} points; --csv FILE writes all)\n", branch.points.size());
    out.add_untitled(report.found.branches.size() == 1 ? "Branch" : fmt::format("Branch {}", number - 1),
                     branch_table(branch, report, units));
  }
  out += notes_text(report.found.notes);
  if (report.found.status != Status::converged && report.found.status != Status::no_cycle)
    out += fmt::format("\nStatus: {}\n", to_string(report.found.status));
  return out;
}

std::string continue_text(const std::string& title, const ContinueReport& report, const Units& units) {
  return continue_document(title, report, units).text();
}

}  // namespace limcycle
