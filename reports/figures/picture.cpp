#include "limcycle/reports/figures/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/figures/thin.hpp"
#include "limcycle/reports/number.hpp"
#include "limcycle/reports/page/html_parts.hpp"
#include "limcycle/reports/predict/answer.hpp"

namespace limcycle {
namespace {

constexpr std::string_view prediction_style =
    "text{font:12px system-ui,sans-serif;fill:#59636e}.frame{fill:none;stroke:#8b949e;stroke-opacity:.5}"
    ".one{fill:none;stroke:#2f81c7;stroke-width:2}.two{fill:none;stroke:#d9661f;stroke-width:2}"
    ".stuck{fill:none;stroke:#d9661f;stroke-width:6;stroke-linecap:round}.title{font-size:14px;font-weight:600}";

struct Panel {
  double left, top, width, height;
  double x_from = 0.0, x_to = 1.0, y_from = 0.0, y_to = 1.0;

  void fit(const std::vector<double>& x, const std::vector<double>& y) {
    const auto [x_low, x_high] = std::minmax_element(x.begin(), x.end());
    const auto [y_low, y_high] = std::minmax_element(y.begin(), y.end());
    const auto margin = [](double low, double high) { return high > low ? 0.06 * (high - low) : 1.0; };
    x_from = *x_low, x_to = *x_high > *x_low ? *x_high : *x_low + 1.0;
    y_from = *y_low - margin(*y_low, *y_high), y_to = *y_high + margin(*y_low, *y_high);
  }
  std::string place(double x, double y) const {
    return fmt::format("{:.1f},{:.1f}", left + width * (x - x_from) / (x_to - x_from),
                       top + height * (1.0 - (y - y_from) / (y_to - y_from)));
  }
  std::string frame(const std::string& name, const std::string& below) const {
    return fmt::format(
        "<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n"
        "<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
        left, top, width, height, left, top - 5.0, html_escaped(name), left + width, top + height + 14.0,
        html_escaped(below));
  }
};

/// The samples of a curve that `keep` selects, joined if they are adjacent.
std::string path(const Panel& panel, const std::string& kind, const std::vector<double>& x,
                 const std::vector<double>& y, const std::vector<bool>& keep = {}) {
  std::string d;
  bool drawing = false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!keep.empty() && !keep[i]) {
      drawing = false;
      continue;
    }
    d += (drawing ? " L" : " M") + panel.place(x[i], y[i]);
    drawing = true;
  }
  return d.empty() ? "" : fmt::format("<path class=\"{}\" d=\"{}\"/>\n", kind, d.substr(1));
}

std::string range_of(const std::vector<double>& values, const std::string& unit) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return with_digits(*low, 3) + " to " + Units::attach(with_digits(*high, 3), unit);
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

const Cycle* drawable(const PredictReport& report) {
  for (const bool stable : {true, false})
    for (const auto& cycle : report.cycles) {
      const auto n = cycle.trace.t.size();
      if (cycle.stable.value_or(false) == stable && n >= 2 && cycle.trace.y.size() == n &&
          cycle.trace.rate.size() == n && cycle.trace.output.size() == n)
        return &cycle;
    }
  return nullptr;
}

std::string panels(const Cycle& cycle, const Units& units) {
  const auto stuck = stuck_samples(cycle.trace, cycle.sticking_fraction);
  // A cycle with fast oscillations is drawn coarsely rather than cut: a part of it would be no period.
  Thinned kept = thin(cycle.trace, 500, stuck);
  if (!kept.whole) kept = thin(cycle.trace, 1000, stuck, INFINITY);
  const auto& index = kept.index;
  const Trace once = picked(cycle.trace, index);
  std::vector<bool> marks;
  marks.reserve(index.size());
  for (const std::size_t i : index) marks.push_back(i < stuck.size() && stuck[i]);
  Trace two = once;
  for (std::size_t i = 0; i < once.t.size(); ++i) {
    two.t.push_back(once.t[i] + once.t.back());
    two.y.push_back(once.y[i]);
    two.output.push_back(once.output[i]);
  }
  const std::string time = fmt::format("0 to {} s", with_digits(two.t.back(), 3));
  Panel above{10, 50, 430, 105}, below{10, 190, 430, 105}, right{460, 50, 290, 245};
  above.fit(two.t, two.y);
  below.fit(two.t, two.output);
  right.fit(once.y, once.rate);
  const double margin = 0.06 * (right.x_to - right.x_from);
  right.x_from -= margin, right.x_to += margin;
  const std::string rate = units.y.empty() ? "1/s" : units.y + "/s";
  const std::string y = name_of_y(once);
  return above.frame(y + ": " + range_of(once.y, units.y), "") + path(above, "one", two.t, two.y) +
         below.frame(
             (units.force.empty() ? "element's output: " : "friction force: ") + range_of(once.output, units.force),
             time) +
         path(below, "two", two.t, two.output) + right.frame("dy/dt: " + range_of(once.rate, rate), y) +
         path(right, "one", once.y, once.rate) + path(right, "stuck", once.y, once.rate, marks);
}

}  // namespace

std::string predict_picture(const PredictReport& report, const Units& units) {
  const std::string all = answer(report, units).what_happens;
  const std::string words = html_escaped(all), first = html_escaped(all.substr(0, all.find(". ")));
  const Cycle* cycle = drawable(report);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 760 {0}\" width=\"760\" height=\"{0}\" role=\"img\" "
      "aria-label=\"{1}\">\n<style>{2}</style>\n<text class=\"title\" x=\"10\" y=\"20\">{3}</text>\n{4}</svg>\n",
      cycle ? 315 : 36, words, prediction_style, first, cycle ? panels(*cycle, units) : "");
}

}  // namespace limcycle
