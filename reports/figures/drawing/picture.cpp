#include "limcycle/reports/figures/drawing/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/figures/drawing/decimate.hpp"
#include "limcycle/reports/figures/drawing/svg_axes.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/page/html_parts.hpp"
#include "limcycle/reports/predict/verdict_text.hpp"

namespace limcycle {
namespace {

constexpr std::string_view prediction_style =
    ".one{fill:none;stroke:#2f81c7;stroke-width:2}.two{fill:none;stroke:#d9661f;stroke-width:2}"
    ".stuck{fill:none;stroke:#d9661f;stroke-width:6;stroke-linecap:round}";

/// The samples of a curve that `keep` selects, joined if they are adjacent.
std::string path(const AxesFrame& frame, const std::string& kind, const std::vector<double>& x,
                 const std::vector<double>& y, const std::vector<bool>& keep = {}) {
  std::string d;
  bool drawing = false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!keep.empty() && !keep[i]) {
      drawing = false;
      continue;
    }
    d += fmt::format("{}{:.1f},{:.1f}", drawing ? " L" : " M", frame.px(x[i]), frame.py(y[i]));
    drawing = true;
  }
  return d.empty() ? "" : fmt::format("<path class=\"{}\" d=\"{}\"/>\n", kind, d.substr(1));
}

/// A frame about curves; time has no room at its ends.
AxesFrame about(AxesFrame frame, const std::vector<double>& x, const std::vector<double>& y, bool of_time) {
  frame.x.include(x);
  frame.y.include(y);
  frame.x.settle(!of_time);
  frame.y.settle();
  return frame;
}

Trace picked(const Trace& from, const std::vector<std::size_t>& index) {
  Trace out;
  out.y_origin = from.y_origin;
  for (const std::size_t i : index) {
    out.t.push_back(from.t[i] - from.t.front());
    out.y.push_back(from.y[i]);
    out.rate.push_back(from.rate[i]);
    out.output.push_back(from.output[i]);
  }
  return out;
}

/// A motion to be drawn: one period of a cycle, which is drawn twice, or some swings of an irregular motion.
struct DrawnMotion {
  Trace trace;
  std::vector<bool> stuck;
  bool period = true;
};

/// The samples of the last `time` of a run.
Trace last_part(const Trace& run, double time) {
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < run.t.size(); ++i)
    if (run.t[i] >= run.t.back() - time) index.push_back(i);
  return picked(run, index);
}

std::optional<DrawnMotion> drawn_motion(const PredictReport& report) {
  for (const bool stable : {true, false})
    for (const auto& cycle : report.cycles)
      if (cycle.stable.value_or(false) == stable && has_element(cycle.trace))
        return DrawnMotion{cycle.trace, stuck_samples(cycle.trace, cycle.sticking_fraction)};
  constexpr double swings = 4.0;
  for (const auto& outcome : report.outcomes) {
    if (outcome.outcome != Outcome::irregular || !has_element(outcome.trace)) continue;
    const Trace part = last_part(outcome.trace, swings * outcome.irregular.mean_period);
    if (part.t.size() > 1) return DrawnMotion{part, std::vector<bool>(part.t.size(), false), false};
  }
  return std::nullopt;
}

std::string panels(const DrawnMotion& drawn, const Units& units) {
  // Fast oscillations are drawn coarsely rather than cut: a part of a period would be none.
  Decimated kept = decimate(drawn.trace, 500, drawn.stuck);
  if (!kept.whole) kept = decimate(drawn.trace, 1000, drawn.stuck, INFINITY);
  const auto& index = kept.index;
  const Trace once = picked(drawn.trace, index);
  std::vector<bool> marks;
  marks.reserve(index.size());
  for (const std::size_t i : index) marks.push_back(i < drawn.stuck.size() && drawn.stuck[i]);
  Trace over = once;
  for (std::size_t i = 0; i < once.t.size() && drawn.period; ++i) {
    over.t.push_back(once.t[i] + once.t.back());
    over.y.push_back(once.y[i]);
    over.output.push_back(once.output[i]);
  }
  const AxesFrame above = about({54, 50, 390, 100}, over.t, over.y, true),
                  below = about({54, 206, 390, 100}, over.t, over.output, true),
                  right = about({508, 50, 242, 256}, once.y, once.rate, false);
  const std::string rate = units.y.empty() ? "1/s" : units.y + "/s", y = name_of_y(once), t = above.x.label("t", "s");
  const std::string output = units.force.empty() ? "output of the element" : "friction force";
  return above.markup() + above.names(t, above.y.label(y, units.y)) + path(above, "one", over.t, over.y) +
         below.markup() + below.names(t, below.y.label(output, units.force)) + path(below, "two", over.t, over.output) +
         right.markup() + right.names(right.x.label(y, units.y), right.y.label("dy/dt", rate)) +
         path(right, "one", once.y, once.rate) + path(right, "stuck", once.y, once.rate, marks);
}

}  // namespace

std::string predict_picture(const PredictReport& report, const Units& units) {
  const std::string all = answer(report, units).what_happens;
  constexpr std::size_t most_characters = 95;  // characters of the title
  std::string first = all.substr(0, all.find(". "));
  if (first.size() > most_characters) first = first.substr(0, first.find(": "));
  const std::string words = html_escaped(all);
  const auto motion = drawn_motion(report);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 760 {0}\" width=\"760\" height=\"{0}\" role=\"img\" "
      "aria-label=\"{1}\">\n<style>{2}{3}</style>\n<text class=\"title\" x=\"10\" y=\"20\">{4}</text>\n{5}</svg>\n",
      motion ? 340 : 36, words, axes_style, prediction_style, html_escaped(first),
      motion ? panels(*motion, units) : "");
}

}  // namespace limcycle
