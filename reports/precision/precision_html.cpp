#include <fmt/format.h>

#include <cmath>

#include "limcycle/reports/figures/drawing/plotly.hpp"
#include "limcycle/reports/figures/work_figures.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/page/html_parts.hpp"
#include "limcycle/reports/page/page.hpp"
#include "limcycle/reports/precision/precision.hpp"

namespace limcycle {
namespace {

WorkMark mark_of(const WorkPoint& point, double x, double y) {
  std::string label = fmt::format("{}, {}: ", point.method, point.setting);
  if (std::isfinite(point.error)) label += "error " + as_error(point.error) + ", ";
  label += fmt::format("{}, {} {} ({})", as_duration(point.seconds), point.evaluations, point.unit,
                       to_string(point.quality));
  return {x, y, point.charted(), label};
}

/// Errors of zero cannot be shown on a logarithmic axis: they are drawn at the uncertainty of the reference.
Figure chart_figure(const WorkChart& chart) {
  std::vector<WorkSeries> series;
  for (const auto& method : chart.methods) {
    WorkSeries one{.name = method, .marks = {}};
    for (const auto& point : chart.points)
      if (point.method == method)
        one.marks.push_back(mark_of(point, point.seconds, std::max(point.error, 0.1 * chart.floor)));
    series.push_back(std::move(one));
  }
  WorkSeries front{.name = "Pareto front", .marks = {}, .joined = true, .dash = 2, .colour = -1};
  for (const std::size_t i : chart.front)
    front.marks.push_back(
        mark_of(chart.points[i], chart.points[i].seconds, std::max(chart.points[i].error, 0.1 * chart.floor)));
  series.push_back(std::move(front));
  const bool cycle = chart.question == "cycle";
  return work_figure(
      cycle ? "work-cycle" : "work-df", cycle ? "Cycle: error against cost" : "Describing function: error against cost",
      front_in_words(chart) + " Crosses: failures; those without an error stand at the upper edge.", "CPU time (s)",
      cycle ? "relative error of period and amplitude" : "worst relative error of the gain", series);
}

Figure stiffness_figure(const StiffnessStudy& study) {
  std::vector<WorkSeries> series;
  std::vector<std::string> steppers, settings;
  std::vector<int> first;
  for (const auto& point : study.points) {
    const auto find = [](auto& list, const std::string& word) {
      const auto at = std::ranges::find(list, word);
      if (at != list.end()) return static_cast<std::size_t>(at - list.begin());
      list.push_back(word);
      return list.size() - 1;
    };
    const std::size_t stepper = find(steppers, point.result.method), setting = find(settings, point.result.setting);
    const std::string name = point.result.method + (setting == 0 ? "" : ", " + point.result.setting);
    auto at = std::ranges::find(series, name, &WorkSeries::name);
    if (at == series.end()) {
      if (stepper == first.size()) first.push_back(static_cast<int>(series.size()));
      series.push_back({name, {}, true, static_cast<int>(setting % 3), setting == 0 ? -1 : first[stepper]});
      at = std::prev(series.end());
    }
    WorkMark mark = mark_of(point.result, point.sigma0, point.result.seconds);
    mark.good = point.result.quality == Quality::right;
    at->marks.push_back(std::move(mark));
  }
  std::string finding = "CPU time of a run over the stiffness of the bristles; lines solid, dashed and dotted for ";
  for (std::size_t i = 0; i < settings.size(); ++i) finding += (i == 0 ? "" : ", ") + settings[i];
  return work_figure("work-stiffness", "Stiffness: limit of each stepper",
                     finding + ". Crosses: not correct (wrong, biased, failed or stopped).", "sigma0", "CPU time (s)",
                     series);
}

std::string chart_html(const WorkChart& chart, const std::string& heading) {
  std::string out = html_tag(heading, chart.question == "cycle" ? "The cycle" : "The describing function") +
                    html_tag("p", reference_in_words(chart));
  if (chart.points.empty()) return out;
  if (chart.question == "cycle") out += html_tag("p", conditions());
  out += html_table(method_table(chart), "CPU time of each method for a given error");
  return out + figures_html({chart_figure(chart)}, heading == "h2") + "<details><summary>All settings</summary>\n" +
         html_table(point_table(chart), "Every method with every setting") + "</details>\n";
}

}  // namespace

std::string precision_sections(const PrecisionReport& report, const Units& units, int level) {
  const std::string heading = "h" + std::to_string(level);
  std::string body;
  if (report.cycle)
    body += html_tag(
        "p", fmt::format("The cycle: period {} s, amplitude {}.",
                         with_error(report.cycle->cycle.period, report.cycle->error),
                         Units::attach(with_error(report.cycle->cycle.amplitude, report.cycle->error), units.y)));
  for (const auto* chart : {&report.cycle_chart, &report.df_chart})
    if (*chart) body += chart_html(**chart, heading);
  if (!report.stiffness.points.empty()) {
    body += html_tag(heading, "Stiffness") +
            html_table(stiffness_table(report.stiffness), "CPU time where the stepper is right, else what it is") +
            figures_html({stiffness_figure(report.stiffness)}) + "<ul>\n";
    for (const auto& note : report.stiffness.notes) body += html_tag("li", note);
    body += "</ul>\n";
  }
  return body + html_notes(report.notes, level);
}

std::string precision_page(const PrecisionReport& report, const Provenance& provenance, const std::string& case_text,
                           const Units& units) {
  return html_page({.provenance = provenance,
                    .answer = precision_answer(report),
                    .body = precision_sections(report, units, 2),
                    .command = "precision",
                    .case_text = case_text,
                    .scripts = {std::string(plotly_script()), std::string(page_script())}});
}

}  // namespace limcycle
