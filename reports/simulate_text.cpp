#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "limcycle/reports/number.hpp"
#include "limcycle/reports/text.hpp"

namespace limcycle {
namespace {

constexpr int digits = 6;

Table ranges(const Simulation& run) {
  Table table{{{"column", "", Align::left}, {"first", ""}, {"least", ""}, {"greatest", ""}, {"last", ""}}, {}};
  for (std::size_t i = 0; i < run.columns.size(); ++i) {
    double least = INFINITY, greatest = -INFINITY;
    for (const auto& row : run.rows) {
      least = std::min(least, row.at(i));
      greatest = std::max(greatest, row.at(i));
    }
    table.rows.push_back({run.columns[i], with_digits(run.rows.front().at(i), digits), with_digits(least, digits),
                          with_digits(greatest, digits), with_digits(run.rows.back().at(i), digits)});
  }
  return table;
}

}  // namespace

std::string simulate_text(const std::string& title, const Simulation& run) {
  std::string out = wrapped(title) + "\n";
  out += fmt::format("{} samples, {} steps of {}", run.rows.size(), run.steps, run.stepper);
  out += run.status == Status::converged ? ".\n" : fmt::format("; ended early: {}.\n", to_string(run.status));
  if (!run.why.empty()) out += wrapped(run.why);
  if (!run.rows.empty()) out += "\n" + ranges(run).text();
  std::map<std::string, std::size_t> kinds;
  for (const auto& event : run.events) ++kinds[event.what];
  if (!kinds.empty()) out += "\nLocated events\n";
  for (const auto& [what, n] : kinds) out += fmt::format("{:>8}  {}\n", n, what);
  return out;
}

}  // namespace limcycle
