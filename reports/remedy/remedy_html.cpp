#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "limcycle/reports/figures/svg_parts.hpp"
#include "limcycle/reports/number.hpp"
#include "limcycle/reports/page/html_parts.hpp"
#include "limcycle/reports/remedy/remedy.hpp"

namespace limcycle {
namespace {

constexpr std::string_view response_style =
    "text{font:12px system-ui,sans-serif;fill:#59636e}.frame{fill:none;stroke:#8b949e;stroke-opacity:.5}"
    ".zero{stroke:#8b949e;stroke-dasharray:4 4}.run{fill:none;stroke:#2f81c7;stroke-width:1.5}"
    ".title{font-size:14px;font-weight:600}";
constexpr double panel_width = 330.0, panel_height = 170.0, panel_top = 52.0, panel_left = 20.0, panel_gap = 20.0;

/// The axes that both panels share: time from 0, and y.
struct ResponseAxes {
  double duration = 0.0, low = 0.0, high = 0.0;
};

/// Until the slower of the two has settled, at most the shorter of both runs if one of them hunts for ever.
ResponseAxes axes_of(const Trace& before, const Trace& after, const std::optional<double>& settled) {
  const auto length = [](const Trace& run) { return run.t.empty() ? 0.0 : run.t.back() - run.t.front(); };
  ResponseAxes axes;
  axes.duration = std::min(std::max(length(before), length(after)),
                           std::max(3.0 * settled.value_or(length(after)), 0.25 * length(before)));
  for (const Trace* run : {&before, &after})
    for (std::size_t i = 0; i < run->t.size() && run->t[i] - run->t.front() <= axes.duration; ++i) {
      axes.low = std::min(axes.low, run->y[i]);
      axes.high = std::max(axes.high, run->y[i]);
    }
  return axes;
}

/// One run as a polyline of some hundred points: the extremes of each column of the picture.
std::string response_curve(const Trace& run, const ResponseAxes& axes, double left) {
  const auto at = [&](std::size_t i) {
    return fmt::format("{:.1f},{:.1f}", place(run.t[i] - run.t.front(), left, panel_width, 0.0, axes.duration),
                       panel_top + panel_height - place(run.y[i], 0.0, panel_height, axes.low, axes.high));
  };
  std::string d;
  const auto add = [&](std::size_t i) { d += (d.empty() ? "M" : " L") + at(i); };
  for (std::size_t i = 0; i < run.t.size() && run.t[i] - run.t.front() <= axes.duration;) {
    const double until = run.t[i] + axes.duration / panel_width;
    std::size_t low = i, high = i, end = i;
    for (; end < run.t.size() && run.t[end] <= until; ++end) {
      if (run.y[end] < run.y[low]) low = end;
      if (run.y[end] > run.y[high]) high = end;
    }
    add(std::min(low, high));
    if (low != high) add(std::max(low, high));
    i = std::max(end, i + 1);
  }
  return d.empty() ? d : R"(<path class="run" d=")" + d + "\"/>\n";
}

}  // namespace

std::string response_picture(const Response& before, const Response& after, const std::optional<double>& settled,
                             const Units& units) {
  if (before.run.t.empty() || after.run.t.empty()) return {};
  const ResponseAxes axes = axes_of(before.run, after.run, settled);
  if (!(axes.duration > 0.0) || !(axes.high > axes.low)) return {};
  std::string body;
  const std::array panels{&before, &after};
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const double left = panel_left + static_cast<double>(k) * (panel_width + panel_gap);
    const double zero = panel_top + panel_height - place(0.0, 0.0, panel_height, axes.low, axes.high);
    body += words_at(left, panel_top - 8.0, "", html_escaped(panels[k]->name));
    body += fmt::format("<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n", left,
                        panel_top, panel_width, panel_height);
    body += line_of(left, zero, left + panel_width, zero, "zero");
    body += response_curve(panels[k]->run, axes, left);
    body += words_at(
        left, panel_top + panel_height + 16.0, "",
        fmt::format("t 0 to {} s, y {} to {}", with_digits(axes.duration, 3), with_digits(axes.low * units.y_per_si, 3),
                    Units::attach(with_digits(axes.high * units.y_per_si, 3), units.y)));
  }
  const std::string label = "Step response " + before.name + " and " + after.name;
  return svg_picture(2.0 * panel_width + panel_gap + 2.0 * panel_left, panel_top + panel_height + 28.0, label,
                     response_style, label, body);
}

std::string remedy_picture(const RemedyReport& report, const Remedy& remedy, const Units& units) {
  return response_picture({"as it stands", report.before}, {"with " + remedy.candidate.name, remedy.after},
                          remedy.costs.settling_time, units);
}

std::string remedy_page(const RemedyReport& report, const Provenance& provenance, const std::string& case_text,
                        const Units& units) {
  std::string body;
  const Table table = remedy_table(report, units);
  if (!table.rows.empty()) {
    body +=
        "<h2>What ends it</h2>\n" + html_table(table,
                                               "Values nearest to the present at which the loop does not hunt; *: no "
                                               "other remedy is at least as good in every cost and better in one");
    body += "<h2>What it costs</h2>\n" + html_table(remedy_cost_table(report, units), "Costs at these values");
    body += "<h2>Before and after</h2>\n";
    for (const Remedy& one : report.remedies)
      if (one.ends == true)
        body += html_picture(remedy_picture(report, one, units),
                             "Step response as it stands and with " + one.candidate.name);
  }
  Table others{{{"remedy", "", Align::left}, {"verdict", "", Align::left}, {"why", "", Align::left}}, {}};
  for (const Remedy& one : report.remedies)
    if (one.ends != true)
      others.rows.push_back({one.candidate.name,
                             !one.candidate.why_not.empty() ? "not tried"
                             : one.ends                     ? "does not end it"
                                                            : "undecided",
                             one.why});
  if (!others.rows.empty()) body += "<h2>The others</h2>\n" + html_table(others, "Remedies that do not end it");
  body += html_notes(report.notes);
  return html_page({.provenance = provenance,
                    .answer = remedy_answer(report, units),
                    .body = body,
                    .command = "remedy",
                    .case_text = case_text});
}

}  // namespace limcycle
