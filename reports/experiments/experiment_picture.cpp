#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/experiments/experiment.hpp"
#include "limcycle/reports/figures/drawing/svg_axes.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/page/html_parts.hpp"

namespace limcycle {
namespace {

constexpr double panel_width = 206, panel_height = 140, left_margin = 44, top_margin = 24, bottom_margin = 34,
                 panel_gap = 16;
constexpr double cell_width = left_margin + panel_width + panel_gap,
                 cell_height = top_margin + panel_height + bottom_margin;
constexpr int picture_columns = 4;
constexpr double picture_width = picture_columns * cell_width;
constexpr std::size_t colours = 10;

constexpr std::string_view figures_style =
    "text{font:11px system-ui,sans-serif;fill:#6b7680}.frame{fill:none;stroke:#8b949e;stroke-opacity:.5}"
    ".tick{stroke:#8b949e;stroke-opacity:.25}.name{font-weight:600;font-size:12px}.title{font-size:14px;font-weight:"
    "600}"
    "path{fill:none;stroke-width:1.3;stroke-linejoin:round}"
    ".c0{stroke:#2f81c7}.c1{stroke:#d9661f}.c2{stroke:#2e9e5b}.c3{stroke:#a05bc4}.c4{stroke:#c4a000}.c5{stroke:#d1477a}"
    ".c6{stroke:#3aa6a6}.c7{stroke:#8a6d3b}.c8{stroke:#7a8a99}.c9{stroke:#5b6ee1}";

/// Names of the curves of all panels, each once, in order; empty if there are too many for a legend.
std::vector<std::string> legend_of(const ExperimentFigure& figure) {
  std::vector<std::string> names;
  for (const auto& panel : figure.panels)
    for (const auto& curve : panel.curves)
      if (!curve.name.empty() && std::ranges::find(names, curve.name) == names.end()) names.push_back(curve.name);
  return names.size() <= 6 ? names : std::vector<std::string>{};
}

std::size_t colour_of(const std::vector<std::string>& legend, const Curve& curve, std::size_t place) {
  const auto at = std::ranges::find(legend, curve.name);
  return (at == legend.end() ? place : static_cast<std::size_t>(at - legend.begin())) % colours;
}

std::string path_of(const AxesFrame& frame, const Curve& curve) {
  std::string d;
  bool pen_up = true;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const double px = frame.px(curve.x[i]), py = frame.py(curve.y[i]);
    if (!std::isfinite(px) || !std::isfinite(py)) {
      pen_up = true;
      continue;
    }
    d += fmt::format("{}{:.1f} {:.1f}", pen_up ? "M" : "L", px, py);
    pen_up = false;
  }
  return d;
}

std::string panel_svg(const ExperimentFigure& figure, const FigurePanel& panel, const std::vector<std::string>& legend,
                      double left, double top) {
  AxesFrame frame{left + left_margin, top + top_margin,          panel_width,
                  panel_height,       Scale(figure.logarithmic), Scale(false)};
  for (const auto& curve : panel.curves)
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (!std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i])) continue;
      frame.x.include(curve.x[i]);
      frame.y.include(curve.y[i]);
    }
  frame.x.settle();
  frame.y.settle();
  std::string out = frame.markup();
  out += fmt::format(
      "<text class=\"name\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text><text x=\"{:.1f}\" y=\"{:.1f}\" "
      "text-anchor=\"end\">{}</text><text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n",
      frame.left, frame.top - 6.0, html_escaped(panel.title), frame.left + panel_width, frame.top - 6.0,
      html_escaped(frame.y.label(figure.y, figure.y_unit)), frame.left + panel_width, frame.top + panel_height + 26.0,
      html_escaped(frame.x.label(figure.x, figure.x_unit)));
  for (std::size_t i = 0; i < panel.curves.size(); ++i)
    if (const std::string d = path_of(frame, panel.curves[i]); !d.empty())
      out +=
          fmt::format("<path class=\"c{}\" d=\"{}\"><title>{}</title></path>\n", colour_of(legend, panel.curves[i], i),
                      d, html_escaped(panel.title + (panel.curves[i].name.empty() ? "" : ": " + panel.curves[i].name)));
  return out;
}

/// A figure's markup below `top`, and its height.
std::pair<std::string, double> figure_svg(const ExperimentFigure& figure, double top) {
  std::string out =
      fmt::format("<text class=\"title\" x=\"8\" y=\"{:.1f}\">{}</text>\n", top + 16.0, html_escaped(figure.heading));
  const auto legend = legend_of(figure);
  double y = top + 26.0;
  if (!legend.empty()) {
    double x = 8.0;
    for (std::size_t i = 0; i < legend.size(); ++i) {
      out +=
          fmt::format("<path class=\"c{0}\" d=\"M{1:.1f} {2:.1f}h22\"/><text x=\"{3:.1f}\" y=\"{4:.1f}\">{5}</text>\n",
                      i, x, y + 6.0, x + 27.0, y + 10.0, html_escaped(legend[i]));
      x += 50.0 + 6.5 * static_cast<double>(display_width(legend[i]));
    }
    y += 18.0;
  }
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const std::size_t row = i / picture_columns, column = i % picture_columns;
    out += panel_svg(figure, figure.panels[i], legend, static_cast<double>(column) * cell_width,
                     y + static_cast<double>(row) * cell_height);
  }
  const std::size_t rows = (figure.panels.size() + picture_columns - 1) / picture_columns;
  return {out, y + static_cast<double>(rows) * cell_height - top};
}

std::string svg(const std::string& body, double height, const std::string& label) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "role=\"img\" aria-label=\"{2}\">\n<style>{3}</style>\n{4}</svg>\n",
      picture_width, height, html_escaped(label), figures_style, body);
}

}  // namespace

std::string experiment_figure(const ExperimentFigure& figure) {
  const auto [body, height] = figure_svg(figure, 0.0);
  return svg(body, height, figure.heading);
}

std::string experiment_picture(const std::vector<Experiment>& experiments) {
  std::string body, label;
  double y = 0.0;
  for (const auto& one : experiments) {
    label += (label.empty() ? "" : "; ") + one.title;
    body += fmt::format("<text class=\"title\" x=\"8\" y=\"{:.1f}\">{}</text>\n", y + 18.0,
                        html_escaped(one.name + ": " + one.title));
    y += 30.0;
    for (const auto& figure : one.figures) {
      if (figure.panels.empty()) continue;
      const auto [markup, height] = figure_svg(figure, y);
      body += markup;
      y += height + 12.0;
    }
  }
  return svg(body, y, label);
}

}  // namespace limcycle
