#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/precision/precision.hpp"

namespace limcycle {
namespace {

constexpr double levels[] = {1e-2, 1e-4, 1e-6, 1e-8, 1e-10};
constexpr double shown_levels[] = {1e-3, 1e-6, 1e-9};  // three of them fit into 80 columns

std::string column_of(const std::string& method) {
  if (method == "describing-function") return "DF";
  return method == "composite-describing-function" ? "composite DF" : method;
}

std::string power_of_ten(double value) { return fmt::format("{:.0e}", value); }

const std::string& question_in_words(const WorkChart& chart) {
  static const std::string cycle = "Period and amplitude of the cycle", df = "Describing function of the element";
  return chart.question == "cycle" ? cycle : df;
}

/// The cheapest point of one method with at most this error.
const WorkPoint* cheapest_of(const WorkChart& chart, const std::string& method, double error) {
  const WorkPoint* best = nullptr;
  for (const auto& point : chart.points)
    if (point.method == method && point.charted() && point.error <= error && (!best || point.seconds < best->seconds))
      best = &point;
  return best;
}

/// "1 wrong, 2 too slow"; "-" if all settings are right.
std::string failures(const WorkChart& chart, const std::string& method) {
  std::map<Quality, int> count;
  for (const auto& point : chart.points)
    if (point.method == method && point.quality != Quality::right) ++count[point.quality];
  std::vector<std::string> words;
  words.reserve(count.size());
  for (const auto& [quality, times] : count) words.push_back(fmt::format("{} {}", times, to_string(quality)));
  return words.empty() ? "-" : fmt::format("{}", fmt::join(words, ", "));
}

/// Reasons why settings of a method are not right, each once.
std::string reasons(const WorkChart& chart) {
  std::string out;
  for (const auto& method : chart.methods) {
    std::vector<std::string> seen;
    for (const auto& point : chart.points) {
      if (point.method != method || point.quality == Quality::right || point.why.empty()) continue;
      const std::string one = fmt::format("{} ({}): {}", point.setting, to_string(point.quality), point.why);
      const auto same = [&](const std::string& other) { return other.ends_with(": " + point.why); };
      if (std::ranges::none_of(seen, same)) seen.push_back(one);
    }
    if (seen.size() > 4) {
      seen.resize(4);
      seen.emplace_back("...");
    }
    for (const auto& one : seen) out += wrapped(method + ", " + one + ".", 80, 2);
  }
  return out;
}

Document chart_document(const WorkChart& chart) {
  Document out("\n" + question_in_words(chart) + "\n" + wrapped(reference_in_words(chart), 80, 2));
  if (chart.points.empty()) return out;
  if (chart.question == "cycle") out += wrapped(conditions(), 80, 2);
  out += "  CPU time of each method for a given error, its least error, its failures:\n";
  out.add_untitled("CPU time of each method for a given error", method_table(chart));
  out += reasons(chart);
  return out;
}

}  // namespace

std::string as_duration(double seconds) {
  if (!std::isfinite(seconds)) return "-";
  if (seconds < 1e-3) return with_digits(1e6 * seconds, 2) + " us";
  if (seconds < 1.0) return with_digits(1e3 * seconds, 2) + " ms";
  return with_digits(seconds, 2) + " s";
}

std::string front_in_words(const WorkChart& chart) {
  std::string out;
  for (std::size_t k = 0; k < std::size(levels); ++k) {
    const std::size_t i = cheapest(chart.points, levels[k]);
    if (i == chart.points.size()) break;
    std::size_t last = k;
    while (last + 1 < std::size(levels) && cheapest(chart.points, levels[last + 1]) == i) ++last;
    const WorkPoint& point = chart.points[i];
    out +=
        fmt::format("{}for {}: {} ({}), {}", out.empty() ? "Cheapest " : "; ",
                    last == k ? power_of_ten(levels[k]) : power_of_ten(levels[k]) + " to " + power_of_ten(levels[last]),
                    point.method, point.setting, as_duration(point.seconds));
    k = last;
  }
  if (out.empty()) return chart.points.empty() ? "" : "No method comes within 1 % of the reference.";
  out += ".";
  if (!chart.never_best.empty()) out += fmt::format(" Never the best choice: {}.", fmt::join(chart.never_best, ", "));
  return out;
}

std::string reference_in_words(const WorkChart& chart) {
  if (!chart.answered) return "No verified reference: " + chart.why + ".";
  const double digits = -std::log10(std::max(chart.agreement, 1e-16));
  return fmt::format("Reference: {}, confirmed to {:.0f} digits by {}.", chart.made_by, std::floor(digits),
                     chart.verified_by);
}

std::string precision_answer(const PrecisionReport& report) {
  std::string out = report.status == Status::interrupted ? "Interrupted; partial result: " : "";
  for (const auto* chart : {&report.cycle_chart, &report.df_chart}) {
    if (!*chart) continue;
    out += (out.empty() || out.back() == ' ' ? "" : " ") + question_in_words(**chart) + ": ";
    std::string words = (*chart)->answered ? front_in_words(**chart) : reference_in_words(**chart);
    if (words.empty()) words = "no method was run.";
    out += static_cast<char>(std::tolower(static_cast<unsigned char>(words[0]))) + words.substr(1);
  }
  return out;
}

std::string conditions() {
  return "Simulations begin on the cycle and run for ten periods; shooting begins 1 % beside it, harmonic balance with "
         "its first harmonics; the describing functions search the whole box. CPU times change from run to run, errors "
         "and counts of steps do not.";
}

Table method_table(const WorkChart& chart) {
  Table table{{{"method", "", Align::left}}, {}};
  for (const double level : shown_levels) table.columns.push_back({power_of_ten(level), ""});
  table.columns.push_back({"least error", ""});
  table.columns.push_back({"not right", "", Align::left});
  for (const auto& method : chart.methods) {
    std::vector<std::string> row{column_of(method)};
    for (const double level : shown_levels) {
      const WorkPoint* best = cheapest_of(chart, method, level);
      row.push_back(best ? as_duration(best->seconds) : "-");
    }
    double least = infinite;
    for (const auto& point : chart.points)
      if (point.method == method && point.charted()) least = std::min(least, point.error);
    row.push_back(std::isfinite(least) ? as_error(least) : "-");
    row.push_back(failures(chart, method));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table point_table(const WorkChart& chart) {
  Table table{{{"method", "", Align::left},
               {"setting", "", Align::left},
               {"error", ""},
               {"state error", ""},
               {"CPU time", ""},
               {"cost", ""},
               {"quality", "", Align::left},
               {"why", "", Align::left}},
              {}};
  for (const auto& point : chart.points)
    table.rows.push_back({point.method, point.setting, std::isfinite(point.error) ? as_error(point.error) : "-",
                          std::isfinite(point.state_error) ? as_error(point.state_error) : "-",
                          as_duration(point.seconds), fmt::format("{} {}", point.evaluations, point.unit),
                          std::string(to_string(point.quality)), point.why});
  return table;
}

Table stiffness_table(const StiffnessStudy& study) {
  Table table{{{"sigma0", ""}, {"setting", "", Align::left}}, {}};
  std::vector<std::string> steppers;
  std::vector<std::pair<double, std::string>> rows;
  for (const auto& point : study.points) {
    if (std::ranges::find(steppers, point.result.method) == steppers.end()) steppers.push_back(point.result.method);
    const std::pair row(point.sigma0, point.result.setting);
    if (std::ranges::find(rows, row) == rows.end()) rows.push_back(row);
  }
  for (const auto& stepper : steppers) table.columns.push_back({stepper, ""});
  for (const auto& [sigma0, setting] : rows) {
    std::vector<std::string> cells{power_of_ten(sigma0), setting};
    for (const auto& stepper : steppers) {
      std::string cell = "-";
      for (const auto& point : study.points)
        if (point.sigma0 == sigma0 && point.result.setting == setting && point.result.method == stepper)
          cell = point.result.quality == Quality::right ? as_duration(point.result.seconds)
                                                        : std::string(to_string(point.result.quality));
      cells.push_back(cell);
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Document precision_document(const std::string& title, const PrecisionReport& report, const Units& units) {
  Document out(wrapped(title) + "\n" + wrapped(precision_answer(report)));
  if (report.cycle)
    out += wrapped(fmt::format("The cycle: period {} s, amplitude {}.",
                               with_error(report.cycle->cycle.period, report.cycle->error),
                               Units::attach(with_error(report.cycle->cycle.amplitude, report.cycle->error), units.y)));
  for (const auto* chart : {&report.cycle_chart, &report.df_chart})
    if (*chart) out += chart_document(**chart);
  if (!report.stiffness.points.empty()) {
    out.add("Stiffness limit of each stepper: CPU time, or the failure", stiffness_table(report.stiffness));
    for (const auto& note : report.stiffness.notes) out += wrapped(note + ".", 80, 2);
  }
  out += notes_text(report.notes);
  if (report.status != Status::converged) out += fmt::format("\nStatus: {}\n", to_string(report.status));
  return out;
}

std::string precision_text(const std::string& title, const PrecisionReport& report, const Units& units) {
  return precision_document(title, report, units).text();
}

}  // namespace limcycle
