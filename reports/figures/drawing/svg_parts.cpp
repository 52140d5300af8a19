#include "limcycle/reports/figures/drawing/svg_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/page/html_parts.hpp"

namespace limcycle {

std::string svg_picture(double width, double height, const std::string& label, std::string_view style,
                        const std::string& title, const std::string& body) {
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
             "height=\"{1:.0f}\" role=\"img\" aria-label=\"{2}\">\n<style>{3}</style>\n<text class=\"title\" x=\"10\" "
             "y=\"20\">{4}</text>\n",
             width, height, html_escaped(label), style, html_escaped(title)) +
         body + "</svg>\n";
}

std::string words_at(double x, double y, std::string_view kind, const std::string& words) {
  return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", kind, x, y, html_escaped(words));
}

std::string line_of(double x1, double y1, double x2, double y2, std::string_view kind) {
  return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", kind, x1, y1, x2,
                     y2);
}

double place(double value, double left, double width, double low, double high) {
  return left + width * std::clamp((value - low) / (high - low), 0.0, 1.0);
}

std::string colour_of_share(double share) {
  const double s = std::round(std::clamp(share, 0.0, 1.0) * 23.0) / 23.0;
  const auto channel = [s](double light, double dark) { return static_cast<int>(light + s * (dark - light)); };
  return fmt::format("#{:02x}{:02x}{:02x}", channel(237, 20), channel(244, 52), channel(250, 110));
}

}  // namespace limcycle
