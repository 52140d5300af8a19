#include <algorithm>
#include <cmath>

#include "limcycle/reports/dissipativity/dissipativity.hpp"
#include "limcycle/reports/experiments/experiment.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/page/html_parts.hpp"

namespace limcycle {
namespace {

/// Values limited for a picture: a slope that grows without bound, which would hide the rest, stays at the edge.
std::vector<double> within(const std::vector<double>& values, double most) {
  std::vector<double> shown = values;
  for (double& value : shown)
    if (!std::isnan(value)) value = std::clamp(value, -most, most);
  return shown;
}

/// Six times the median size of the finite values.
double readable(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> sizes;
  for (const auto* values : {&a, &b})
    for (const double value : *values)
      if (std::isfinite(value)) sizes.push_back(std::abs(value));
  if (sizes.empty()) return 1.0;
  const auto middle = sizes.begin() + std::ssize(sizes) / 2;
  std::nth_element(sizes.begin(), middle, sizes.end());
  return 6.0 * *middle;
}

ExperimentFigure storage_figure(const StorageCurve& curve) {
  ExperimentFigure figure{
      "storage", "Slope of the storage over the state: passive where the lower bound is below the upper one",
      "z",       "m",
      "dS/dz",   "N"};
  const double most = readable(curve.least, curve.most);
  figure.panels.push_back(
      {"slope", {{"least", curve.z, within(curve.least, most)}, {"most", curve.z, within(curve.most, most)}}});
  return figure;
}

ExperimentFigure available_figure(const StorageCurve& curve) {
  ExperimentFigure figure{"available", "Energy that can be taken out from each state", "z", "m", "available storage",
                          "J"};
  figure.panels.push_back({"available", {{"available storage", curve.z, curve.available}}});
  return figure;
}

ExperimentFigure input_figure(const Counterexample& found) {
  ExperimentFigure figure{"input", "One cycle of the motion that takes energy out", "time", "s", "v", "m/s"};
  figure.panels.push_back({"velocity", {{"v", found.input.time, found.input.velocity}}});
  return figure;
}

ExperimentFigure taken_figure(const Counterexample& found) {
  ExperimentFigure figure{"taken", "Energy taken out of the law, from rest", "cycles", "", "energy", "J"};
  std::vector<double> cycles{0.0}, taken{0.0};
  for (std::size_t i = 0; i < found.taken.size(); ++i) {
    cycles.push_back(static_cast<double>(i + 1));
    taken.push_back(found.taken[i]);
  }
  figure.panels.push_back({"taken out", {{"energy", cycles, taken}}});
  return figure;
}

ExperimentFigure resistance_figure(const LoopDissipation& loop) {
  ExperimentFigure figure{
      "resistance", "Resistance of the rest of the loop to the rubbing: what of the energy it takes up",
      "w",          "rad/s",
      "Re Z(jw)",   "N s/m",
      true};
  std::vector<double> w, real;
  for (int i = 0; i <= 240; ++i) {
    w.push_back(std::pow(10.0, -3.0 + 7.0 * i / 240.0));
    real.push_back(loop.impedance.resistance(w.back()));
  }
  figure.panels.push_back({"resistance", {{"Re Z(jw)", w, within(real, readable(real, real))}}});
  return figure;
}

}  // namespace

std::vector<ExperimentFigure> dissipativity_figures(const DissipativityReport& report) {
  std::vector<ExperimentFigure> figures;
  if (const auto& curve = report.passivity.storage; curve && curve->z.size() > 1) {
    figures.push_back(storage_figure(*curve));
    if (curve->available.size() == curve->z.size() &&
        std::ranges::all_of(curve->available, [](double a) { return std::isfinite(a); }))
      figures.push_back(available_figure(*curve));
  }
  if (const auto& found = report.passivity.counterexample) {
    figures.push_back(input_figure(*found));
    if (!found->taken.empty()) figures.push_back(taken_figure(*found));
  }
  if (report.loop && report.loop->impedance.applies().decision == Decision::yes)
    figures.push_back(resistance_figure(*report.loop));
  return figures;
}

std::string dissipativity_sections(const DissipativityReport& report, int level) {
  const std::string heading = "h" + std::to_string(level);
  Table facts{{{"", "", Align::left}, {"", "", Align::left}}, passivity_facts(report)};
  std::string body = html_tag(heading, "Passivity") + html_table(facts, "Findings");
  if (const auto& found = report.passivity.counterexample) {
    body += html_tag("p", found->words);
    body += html_table(counterexample_table(*found), "One cycle of the counter-example");
  }
  for (const auto& figure : dissipativity_figures(report))
    body += html_picture(experiment_figure(figure), figure.heading, experiment_figure_csv(figure));
  if (report.over_all)
    body += html_tag(heading, "Bounds") + html_table(bound_table(report), "Bounds of states and force");
  if (report.loop) body += html_tag(heading, "Loop") + html_table(loop_table(report), "Energy criteria for the loop");
  return body + html_notes(report.notes, level);
}

std::string dissipativity_page(const DissipativityReport& report, const Provenance& provenance,
                               const std::string& case_text, const std::string& flags) {
  return html_page({.provenance = provenance,
                    .answer = dissipativity_answer(report),
                    .body = dissipativity_sections(report, 2),
                    .command = "dissipativity",
                    .flags = flags,
                    .case_text = case_text});
}

}  // namespace limcycle
