#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/text.hpp"

namespace limcycle {
namespace {

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

/// "2 roots, residuals up to 3.1e-12; ...": results of a method, and its effort if that is counted.
std::string method_text(const std::string& method, const PredictReport& report) {
  if (std::ranges::find(report.efforts, method, &Effort::method) == report.efforts.end())
    return report.status == Status::interrupted ? "not reached" : "does not apply to this loop";
  std::size_t found = 0;
  double residual = 0.0;
  int harmonics = 1;
  for (const auto& one : report.predictions) {
    if (one.method != method) continue;
    ++found;
    residual = std::max(residual, one.residual);
    harmonics = std::max(harmonics, one.harmonics);
  }
  std::string text = counted(found, "root", "roots");
  if (found > 0) text += ", residual at most " + with_digits(residual, 2);
  if (harmonics > 1) text += ", " + std::to_string(harmonics) + " harmonics";
  for (const auto& effort : report.efforts)
    if (effort.method == method && !effort.unit.empty()) text += fmt::format("; {} {}", effort.count, effort.unit);
  if (std::ranges::find(report.unfinished, method) != report.unfinished.end()) text += "; interrupted";
  return text;
}

std::string shooting_text(const PredictReport& report) {
  std::string text = counted(report.cycles.size(), "cycle", "cycles");
  double residual = 0.0;
  for (const auto& cycle : report.cycles) residual = std::max(residual, cycle.residual);
  if (!report.cycles.empty()) text += ", |x(T) - x(0)| at most " + with_digits(residual, 2) + " of its size";
  for (const auto& effort : report.efforts)
    if (effort.method == "shooting") text += fmt::format("; {} {}", effort.count, effort.unit);
  return text;
}

}  // namespace

std::string predict_efforts(const PredictReport& report, const Methods& methods, const Units& units) {
  constexpr std::size_t width = 29;
  std::string out = "\nWork done\n";
  const auto names = std::to_array<std::pair<bool, const char*>>({{methods.describing_function, "describing-function"},
                                                                  {methods.composite, "composite-describing-function"},
                                                                  {methods.harmonic_balance, "harmonic-balance"}});
  for (const auto& [wanted, name] : names)
    out += item(name, width, wanted ? method_text(name, report) : "not asked for");
  long steps = 0;
  for (const auto& one : report.outcomes) steps += one.steps;
  out += item("simulation", width, fmt::format("{}, {} steps", counted(report.outcomes.size(), "run", "runs"), steps));
  for (const auto& one : report.outcomes)
    out += item("  " + std::string(to_string(one.outcome)), width,
                fmt::format("{} s in {} steps, from {}", with_digits(one.time, 4), one.steps,
                            start_in_words(one.start, units)));
  out += item("shooting", width, shooting_text(report));
  return out + item("status", width, std::string(to_string(report.status)));
}

}  // namespace limcycle
