#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "limcycle/reports/page/html_parts.hpp"
#include "limcycle/reports/precision/atlas.hpp"

namespace limcycle {
namespace {

struct Look {
  RunClass kind;
  const char* colour;
  const char* letter;
};
/// Letters too, for readers who cannot distinguish the colours.
constexpr std::array<Look, 9> looks{{{RunClass::right, "#2e9e5b", ""},
                                     {RunClass::rough, "#9fce63", "~"},
                                     {RunClass::creeps, "#f2c14e", "c"},
                                     {RunClass::wrong_motion, "#e07b39", "w"},
                                     {RunClass::stops, "#b07cc6", "s"},
                                     {RunClass::chatters, "#5f8dd3", "f"},
                                     {RunClass::misses_event, "#c2354a", "m"},
                                     {RunClass::diverges, "#6b1d2a", "x"},
                                     {RunClass::too_slow, "#b9bec4", "t"}}};

const Look& look_of(RunClass kind) { return *std::ranges::find(looks, kind, &Look::kind); }

constexpr double square_width = 17.0, square_height = 13.0, stepper_width = 150.0, atlas_width = 760.0,
                 outer_margin = 10.0;
constexpr std::string_view atlas_style =
    "text{font:11px system-ui,sans-serif;fill:#59636e}.title{font-size:14px;font-weight:600}.law{font-size:13px;"
    "font-weight:600}.cell{fill:#fff;text-anchor:middle;font-weight:600}.dark{fill:#1f2328}rect{stroke:#8b949e;"
    "stroke-opacity:.35}";

template <class T, class Get>
std::vector<T> distinct(const std::vector<const AtlasPoint*>& points, const Get& get) {
  std::vector<T> found;
  for (const auto* point : points)
    if (std::ranges::find(found, get(*point)) == found.end()) found.push_back(get(*point));
  return found;
}

/// The stiffness, with 0 for NaN, so that it can be compared.
double stiffness_or_zero(const AtlasPoint& point) { return std::isfinite(point.stiffness) ? point.stiffness : 0.0; }

std::string text(double x, double y, std::string_view kind, const std::string& words) {
  return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", kind, x, y, html_escaped(words));
}

std::string cell(double x, double y, const AtlasPoint& point) {
  const Look& look = look_of(point.kind);
  const std::string words = fmt::format("{}, {} {:.0e}: {}{}{}", point.stepper, point.fixed_step ? "step" : "rtol",
                                        point.setting, to_string(point.kind), point.why.empty() ? "" : ", ", point.why);
  std::string out =
      fmt::format(R"(<g><title>{}</title><rect x="{:.1f}" y="{:.1f}" width="{:.0f}" height="{:.0f}" fill="{}"/>)",
                  html_escaped(words), x, y, square_width, square_height, look.colour);
  if (*look.letter != 0) {
    const bool light = point.kind != RunClass::misses_event && point.kind != RunClass::diverges;
    out += fmt::format(R"(<text class="cell{}" x="{:.1f}" y="{:.1f}">{}</text>)", light ? " dark" : "",
                       x + 0.5 * square_width, y + square_height - 3.5, look.letter);
  }
  return out + "</g>\n";
}

/// One stepper: settings downwards, stiffness to the right.
std::string panel(double left, double top, const std::vector<const AtlasPoint*>& points) {
  const auto settings = distinct<double>(points, [](const AtlasPoint& point) { return point.setting; });
  const auto columns = distinct<double>(points, stiffness_or_zero);
  std::string out = text(left, top, "", points.front()->stepper);
  const double x0 = left + 36.0, y0 = top + 6.0;
  for (std::size_t i = 0; i < settings.size(); ++i)
    out += text(left, y0 + square_height * static_cast<double>(i + 1) - 3.0, "", fmt::format("{:.0e}", settings[i]));
  for (const auto* point : points) {
    const auto column = std::ranges::find(columns, stiffness_or_zero(*point)) - columns.begin();
    const auto row = std::ranges::find(settings, point->setting) - settings.begin();
    out += cell(x0 + square_width * static_cast<double>(column), y0 + square_height * static_cast<double>(row), *point);
  }
  const double below = y0 + square_height * static_cast<double>(settings.size()) + 11.0;
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i] > 0.0)
      out += text(x0 + square_width * static_cast<double>(i) + 4.0, below, "",
                  fmt::format("{:.0f}", std::log10(columns[i])));
  return out;
}

struct Drawn {
  std::string markup;
  double bottom;
};

Drawn law_panels(const StepperAtlas& atlas, const std::string& law, double top) {
  std::vector<const AtlasPoint*> own;
  for (const auto& point : atlas.points)
    if (point.law == law) own.push_back(&point);
  Drawn drawn{text(outer_margin, top + 14.0, "law", law), top + 24.0};
  double left = outer_margin, row_height = 0.0;
  for (const auto& stepper : distinct<std::string>(own, [](const AtlasPoint& point) { return point.stepper; })) {
    std::vector<const AtlasPoint*> points;
    std::ranges::copy_if(own, std::back_inserter(points), [&](const auto* point) { return point->stepper == stepper; });
    const auto rows = distinct<double>(points, [](const AtlasPoint& point) { return point.setting; }).size();
    const double height = 40.0 + square_height * static_cast<double>(rows);
    if (left + stepper_width > atlas_width) {
      left = outer_margin;
      drawn.bottom += row_height;
      row_height = 0.0;
    }
    drawn.markup += panel(left, drawn.bottom + 8.0, points);
    left += stepper_width;
    row_height = std::max(row_height, height);
  }
  drawn.bottom += row_height;
  return drawn;
}

std::string legend(double top) {
  std::string out;
  double left = outer_margin;
  for (const auto& look : looks) {
    AtlasPoint sample;
    sample.kind = look.kind;
    const std::string name(to_string(look.kind));
    out += fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.0f}" height="{:.0f}" fill="{}"/>)", left, top,
                       square_width, square_height, look.colour) +
           text(left + 21.0, top + 10.0, "", std::string(look.letter) + (*look.letter == 0 ? "" : " ") + name);
    left += 36.0 + 6.0 * static_cast<double>(name.size() + 1);
  }
  return out;
}

}  // namespace

std::string atlas_picture(const StepperAtlas& atlas) {
  std::vector<std::string> laws;
  for (const auto& point : atlas.points)
    if (std::ranges::find(laws, point.law) == laws.end()) laws.push_back(point.law);
  std::string body = text(outer_margin, 20.0, "title",
                          "Where steppers fail: tolerance (or step, s) against log10 of the stiffness, N/m");
  body += legend(32.0);
  double top = 56.0;
  for (const auto& law : laws) {
    const Drawn drawn = law_panels(atlas, law, top);
    body += drawn.markup;
    top = drawn.bottom + 6.0;
  }
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
             "height=\"{1:.0f}\" role=\"img\" aria-label=\"{2}\">\n<style>{3}</style>\n",
             atlas_width, top, html_escaped(atlas_answer(atlas)), atlas_style) +
         body + "</svg>\n";
}

}  // namespace limcycle
