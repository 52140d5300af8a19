#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "limcycle/reports/figures/drawing/svg_parts.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/map/map.hpp"
#include "limcycle/reports/page/html_parts.hpp"

namespace limcycle {
namespace {

constexpr double map_side = 216.0, map_pitch = 252.0, map_picture_width = 766.0;
constexpr std::string_view map_style =
    "text{font:11px system-ui,sans-serif;fill:#59636e}.title{font-size:14px;font-weight:600}.name{font-size:12px;"
    "font-weight:600}.frame{fill:none;stroke:#8b949e;stroke-opacity:.6}.end{text-anchor:end}.middle{text-anchor:"
    "middle}";

using ColourOf = std::function<std::string(const MapPoint&)>;
using Legend = std::vector<std::pair<std::string, std::string>>;  // colour, words

std::string colour_of_what(const MapPoint& point) {
  switch (map_letter(point)) {
    case '.':
      return "#bcd9c0";
    case 'H':
      return "#c8442f";
    case '+':
      return "#eda352";
    case '*':
      return "#b56bb0";
    case 's':
      return "#6ea3d8";
    case 'x':
      return "#3b2f45";
    case '~':
      return "#8a5a2b";
    case 'o':
      return "#d9a7c7";
    case '/':
      return "#ffffff";
    default:
      return "#b9bec4";
  }
}

std::string colour_of_worth(Worth worth) {
  constexpr std::string_view colours[] = {"#5ca66a", "#f2c14e", "#d1495b", "#7a4fa3", "#b9bec4", "#eef0f2"};
  return std::string(colours[static_cast<std::size_t>(worth)]);
}

/// Adjacent cells of a row with the same colour are one rectangle.
std::string cells(const HuntingMap& map, double left, double top, const ColourOf& colour_of) {
  const double width = map_side / map.x.points, height = map_side / map.y.points;
  std::string out;
  for (int row = 0; row < map.y.points; ++row) {
    const auto colour = [&](int column) -> std::string {
      const auto& point = map.at(column, row);
      return point ? colour_of(*point) : "";
    };
    for (int column = 0, next = 0; column < map.x.points; column = next) {
      const std::string here = colour(column);
      for (next = column + 1; next < map.x.points && colour(next) == here;) ++next;
      if (here.empty()) continue;
      // Slightly wider than the cells, so that the page does not shine through between them.
      out += fmt::format(R"(<rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" fill="{}"/>)",
                         left + column * width, top + map_side - (row + 1) * height, (next - column) * width + 0.3,
                         height + 0.3, here);
      out += "\n";
    }
  }
  return out;
}

std::string panel_of(const MapReport& report, double left, double top, const std::string& name, const ColourOf& colour,
                     const Legend& legend) {
  const MapAxis &x = report.map.x, &y = report.map.y;
  const auto last = [](const std::string& path) { return path.substr(path.rfind('.') + 1); };
  std::string out =
      fmt::format("<text class=\"name\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left, top - 6.0, html_escaped(name));
  out += cells(report.map, left, top, colour);
  out += fmt::format("<rect class=\"frame\" x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"{2:.1f}\" height=\"{2:.1f}\"/>\n", left,
                     top, map_side);
  const double labels = top + map_side + 13.0;
  out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left, labels, with_digits(x.from, 3));
  out += fmt::format("<text class=\"middle\" x=\"{:.1f}\" y=\"{:.1f}\">{}{}</text>\n", left + 0.5 * map_side, labels,
                     html_escaped(last(x.path)), x.logarithmic ? " (log)" : "");
  out += fmt::format("<text class=\"end\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left + map_side, labels,
                     with_digits(x.to, 3));
  const double side = left - 5.0;
  const auto along = [&](double at, const char* kind, const std::string& words) {
    return fmt::format("<text class=\"{0}\" transform=\"translate({1:.1f} {2:.1f}) rotate(-90)\">{3}</text>\n", kind,
                       side, at, html_escaped(words));
  };
  out += along(top + map_side, "", with_digits(y.from, 3)) +
         along(top + 0.5 * map_side, "middle", last(y.path) + (y.logarithmic ? " (log)" : "")) +
         along(top, "end", with_digits(y.to, 3));
  double at = left, line = labels + 9.0;
  for (const auto& [fill, words] : legend) {
    const double wide = 18.0 + 5.6 * static_cast<double>(words.size());
    if (at > left && at + wide > left + map_side + 20.0) {
      at = left;
      line += 15.0;
    }
    out += fmt::format(
        "<rect class=\"key\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"10\" height=\"10\" fill=\"{}\" "
        "stroke=\"#8b949e\" stroke-opacity=\".5\"/><text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
        at, line, fill, at + 14.0, line + 9.0, html_escaped(words));
    at += wide + 6.0;
  }
  return out;
}

struct MapPanel {
  std::string name;
  ColourOf colour;
  Legend legend;
};

MapPanel what_panel(const HuntingMap& map) {
  MapPanel panel{"Outcome", colour_of_what, {}};
  for (const auto& point : map.points) {
    if (!point) continue;
    const std::pair entry(colour_of_what(*point), point->in_words());
    if (std::ranges::find(panel.legend, entry.first, [](const auto& one) { return one.first; }) == panel.legend.end())
      panel.legend.push_back(entry);
  }
  return panel;
}

/// Panel of the stable cycle with the largest amplitude; logarithmic if it spans more than a factor of ten.
MapPanel number_panel(const HuntingMap& map, const std::string& name, const std::string& unit,
                      double MapPoint::*quantity) {
  double low = infinite, high = 0.0;
  for (const auto& point : map.points)
    if (point && (*point).*quantity > 0.0) {
      low = std::min(low, (*point).*quantity);
      high = std::max(high, (*point).*quantity);
    }
  const bool logarithmic = high > 10.0 * low;
  const auto share = [=](double value) {
    if (!(high > low)) return 0.5;
    return logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  };
  MapPanel panel{name + (logarithmic ? " (log)" : ""), {}, {}};
  panel.colour = [=](const MapPoint& point) {
    return point.*quantity > 0.0 ? colour_of_share(share(point.*quantity)) : std::string("#ffffff");
  };
  if (high > 0.0)
    panel.legend = {{colour_of_share(0.0), with_digits(low, 3)},
                    {colour_of_share(1.0), Units::attach(with_digits(high, 3), unit)},
                    {"#ffffff", "none"}};
  return panel;
}

MapPanel worth_panel(const HuntingMap& map, std::size_t method) {
  MapPanel panel{map.methods[method], {}, {}};
  panel.colour = [method](const MapPoint& point) {
    return method < point.methods.size() ? colour_of_worth(point.methods[method].worth) : std::string("#ffffff");
  };
  for (int kind = 0; kind <= static_cast<int>(Worth::not_applicable); ++kind) {
    const auto worth = static_cast<Worth>(kind);
    if (std::ranges::any_of(map.points, [&](const auto& point) {
          return point && method < point->methods.size() && point->methods[method].worth == worth;
        }))
      panel.legend.emplace_back(colour_of_worth(worth), to_string(worth));
  }
  return panel;
}

}  // namespace

std::string map_picture(const MapReport& report, const Units& units) {
  std::vector<MapPanel> panels{what_panel(report.map),
                               number_panel(report.map, "Amplitude", units.y, &MapPoint::amplitude),
                               number_panel(report.map, "Period", "s", &MapPoint::period)};
  for (std::size_t m = 0; m < report.map.methods.size(); ++m) panels.push_back(worth_panel(report.map, m));
  constexpr double row_height = map_side + 76.0;
  std::string body;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const std::size_t row = i / 3;
    body += panel_of(report, 22.0 + map_pitch * static_cast<double>(i % 3),
                     52.0 + row_height * static_cast<double>(row), panels[i].name, panels[i].colour, panels[i].legend);
  }
  const std::size_t rows = (panels.size() + 2) / 3;
  const double height = 34.0 + row_height * static_cast<double>(rows);
  return svg_picture(map_picture_width, height, map_answer(report), map_style,
                     report.map.y.path + " over " + report.map.x.path, body);
}

std::string map_sections(const MapReport& report, const Units& units, int level) {
  const std::string heading = "h" + std::to_string(level);
  const std::string about = "Outcome of motions from several starts, amplitude and period of the largest stable cycle";
  std::string body =
      html_tag(heading, "The map") +
      html_picture(map_picture(report, units),
                   about + (report.map.methods.empty() ? "." : ", and reliability of each method."), map_csv(report));
  body += html_tag(heading, "Outcome") + html_table(happens_table(report), "Points of the map by outcome");
  if (!report.map.methods.empty())
    body += html_tag(heading, "Reliability of the methods") +
            html_table(worth_table(report), "Shares of the map, by method");
  return body;
}

std::string map_page(const MapReport& report, const Provenance& provenance, const std::string& case_text,
                     const Units& units, const std::string& flags) {
  return html_page({.provenance = provenance,
                    .answer = map_answer(report),
                    .body = map_sections(report, units, 2),
                    .command = "map",
                    .flags = flags,
                    .case_text = case_text});
}

}  // namespace limcycle
