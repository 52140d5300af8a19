#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "limcycle/reports/document_header.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/store/status.hpp"

namespace limcycle {
namespace {

std::string count_of(std::size_t count, const std::string& one) {
  return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
}

/// State of the computation, and advice if it is not running.
std::string who_writes(const StoredSweep& sweep) {
  const StoreActivity& activity = sweep.activity;
  if (activity.running)
    return activity.pid > 0 ? fmt::format("Process {} is computing.", activity.pid) : "Another process is computing.";
  if (activity.known == sweep.identity.points) return "Complete.";
  return "No process is running: continue by the same command with --resume.";
}

std::string pace(const StoredSweep& sweep, double now) {
  const StoreActivity& activity = sweep.activity;
  std::string text = fmt::format("Session {}: {} stored", activity.sessions, count_of(activity.session_rows, "point"));
  if (activity.rate() > 0.0) text += fmt::format(", {} a second", with_digits(activity.rate(), 3));
  if (const double left = seconds_left(sweep); left > 0.0)
    text += fmt::format(", {} left at that rate", as_waiting_time(left));
  // Two clocks may differ: a negative age counts as 0.
  return wrapped(text + ".") +
         fmt::format("Last written {} ago.\n", as_waiting_time(std::max(0.0, now - activity.written)));
}

Table summary_table(const StoredSweep& sweep) {
  Table table{{{"column", "", Align::left}, {"finite", ""}, {"minimum", ""}, {"mean", ""}, {"maximum", ""}}, {}};
  for (const auto& column : column_summaries(sweep))
    table.rows.push_back({column.name, std::to_string(column.finite), with_digits(column.minimum, 6),
                          with_digits(column.mean, 6), with_digits(column.maximum, 6)});
  return table;
}

}  // namespace

std::vector<ColumnSummary> column_summaries(const StoredSweep& sweep) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const std::size_t columns = sweep.identity.columns.size();
  std::vector<ColumnSummary> all;
  for (std::size_t k = 0; k < columns; ++k) {
    ColumnSummary summary{sweep.identity.columns[k], 0, none, none, none};
    for (std::size_t i = 0; i < sweep.known.size(); ++i) {
      const double value = sweep.rows[i * columns + k];
      if (!sweep.known[i] || !std::isfinite(value)) continue;
      const auto count = static_cast<double>(++summary.finite);
      summary.minimum = summary.finite == 1 ? value : std::min(summary.minimum, value);
      summary.maximum = summary.finite == 1 ? value : std::max(summary.maximum, value);
      // Running mean, in a form that overflows only if the mean itself is too large.
      summary.mean = summary.finite == 1 ? value : summary.mean + (value / count - summary.mean / count);
    }
    all.push_back(std::move(summary));
  }
  return all;
}

double seconds_left(const StoredSweep& sweep) {
  const std::size_t missing = sweep.identity.points - sweep.activity.known;
  if (missing == 0) return 0.0;
  const double rate = sweep.activity.rate();
  return rate > 0.0 ? static_cast<double>(missing) / rate : std::numeric_limits<double>::quiet_NaN();
}

std::string status_text(const std::string& file, const StoredSweep& sweep, double now) {
  const std::size_t points = sweep.identity.points, known = sweep.activity.known;
  std::string text = sweep.identity.title.empty() ? "" : wrapped(sweep.identity.title) + "\n";
  const double share = points > 0 ? static_cast<double>(known) / static_cast<double>(points) : 1.0;
  text += wrapped(fmt::format("{}, {}: {} of {} known ({}).", file, sweep.identity.command, known,
                              count_of(points, "point"), as_percent(share)));
  text += who_writes(sweep) + "\n";
  text += pace(sweep, now);
  if (known == 0) return text;
  return text + "\n" + (known < points ? "Provisional results\n" : "Results\n") + summary_table(sweep).text();
}

std::string status_csv(const StoredSweep& sweep) {
  std::vector<std::string> names{"point"};
  names.insert(names.end(), sweep.identity.columns.begin(), sweep.identity.columns.end());
  std::string text = csv_line(names);
  const std::size_t columns = sweep.identity.columns.size();
  for (std::size_t i = 0; i < sweep.known.size(); ++i) {
    if (!sweep.known[i]) continue;
    text += std::to_string(i);
    for (std::size_t k = 0; k < columns; ++k) {
      text += ',';
      append_shortest(text, sweep.rows[i * columns + k]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace limcycle
