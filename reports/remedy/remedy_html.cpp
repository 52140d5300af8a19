#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/figures/drawing/svg_axes.hpp"
#include "limcycle/reports/figures/drawing/svg_parts.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/page/html_parts.hpp"
#include "limcycle/reports/remedy/remedy.hpp"

namespace limcycle {
namespace {

constexpr std::string_view response_style =
    ".zero{stroke:#8b949e;stroke-dasharray:4 4}.run{fill:none;stroke:#2f81c7;stroke-width:1.5}";
constexpr double trace_width = 300.0, trace_height = 170.0, trace_top = 68.0, trace_left = 48.0, trace_gap = 56.0;

double length_of(const Trace& run) { return run.t.empty() ? 0.0 : run.t.back() - run.t.front(); }

/// The axes that both panels share. Time goes until the slower of the two has settled, at most the shorter of both runs
/// if one of them hunts for ever.
AxesFrame shared_axes(const Trace& before, const Trace& after, const std::optional<double>& settled, double per_si) {
  AxesFrame frame{trace_left, trace_top, trace_width, trace_height};
  const double duration = std::min(std::max(length_of(before), length_of(after)),
                                   std::max(3.0 * settled.value_or(length_of(after)), 0.25 * length_of(before)));
  frame.x.include({0.0, duration});
  frame.y.include(0.0);
  for (const Trace* run : {&before, &after})
    for (std::size_t i = 0; i < run->t.size() && run->t[i] - run->t.front() <= duration; ++i)
      frame.y.include(run->y[i] * per_si);
  frame.x.settle(false);
  frame.y.settle();
  return frame;
}

/// One run as a polyline of some hundred points: the extremes of each column of the picture.
std::string response_curve(const Trace& run, const AxesFrame& frame, double per_si) {
  const double from = run.t.empty() ? 0.0 : run.t.front(), right = frame.left + frame.width + 1e-6;
  std::string d;
  const auto add = [&](std::size_t i) {
    d += fmt::format("{}{:.1f},{:.1f}", d.empty() ? "M" : " L", frame.px(run.t[i] - from), frame.py(run.y[i] * per_si));
  };
  const auto is_inside = [&](std::size_t i) { return i < run.t.size() && frame.px(run.t[i] - from) <= right; };
  for (std::size_t i = 0; is_inside(i);) {
    const double until = frame.px(run.t[i] - from) + 1.0;
    std::size_t low = i, high = i, end = i;
    for (; is_inside(end) && frame.px(run.t[end] - from) <= until; ++end) {
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
  if (!(length_of(before.run) > 0.0) || !(length_of(after.run) > 0.0)) return {};
  AxesFrame frame = shared_axes(before.run, after.run, settled, units.y_per_si);
  std::string body;
  for (const Response* one : {&before, &after}) {
    const double zero = frame.py(0.0);
    body += words_at(frame.left, trace_top - 24.0, "", html_escaped(one->name)) + frame.markup() +
            frame.names(frame.x.label("t", "s"), frame.y.label("y", units.y)) +
            line_of(frame.left, zero, frame.left + frame.width, zero, "zero") +
            response_curve(one->run, frame, units.y_per_si);
    frame.left += trace_width + trace_gap;
  }
  const std::string label = "Step response " + before.name + " and " + after.name;
  return svg_picture(frame.left - trace_gap + 12.0, trace_top + trace_height + 34.0, label,
                     std::string(axes_style) + std::string(response_style), label, body);
}

std::string remedy_picture(const RemedyReport& report, const Remedy& remedy, const Units& units) {
  return response_picture({"as it stands", report.before}, {"with " + remedy.candidate.name, remedy.after},
                          remedy.costs.settling_time, units);
}

std::string remedy_sections(const RemedyReport& report, const Units& units, int level) {
  const auto heading = [&](const std::string& words) { return html_tag(fmt::format("h{}", level), words); };
  std::string body;
  const Table table = remedy_table(report, units);
  if (!table.rows.empty()) {
    body += heading("What ends it") + html_table(table,
                                                 "Values nearest to the present at which the loop does not hunt; *: no "
                                                 "other remedy is at least as good in every cost and better in one");
    body += heading("What it costs") + html_table(remedy_cost_table(report, units), "Costs at these values");
    std::string pictures;
    for (const Remedy& one : report.remedies)
      if (one.ends == true)
        pictures += html_picture(remedy_picture(report, one, units),
                                 "Step response as it stands and with " + one.candidate.name);
    if (!pictures.empty()) body += heading("Before and after") + pictures;
  }
  Table others{{{"remedy", "", Align::left}, {"verdict", "", Align::left}, {"why", "", Align::left}}, {}};
  for (const Remedy& one : report.remedies)
    if (one.ends != true)
      others.rows.push_back({one.candidate.name,
                             !one.candidate.why_not.empty() ? "not tried"
                             : one.ends                     ? "does not end it"
                                                            : "undecided",
                             one.why});
  if (!others.rows.empty()) body += heading("The others") + html_table(others, "Remedies that do not end it");
  return body;
}

std::string remedy_page(const RemedyReport& report, const Provenance& provenance, const std::string& case_text,
                        const Units& units) {
  return html_page({.provenance = provenance,
                    .answer = remedy_answer(report, units),
                    .body = remedy_sections(report, units, 2) + html_notes(report.notes),
                    .command = "remedy",
                    .case_text = case_text});
}

}  // namespace limcycle
