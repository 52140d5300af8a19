#include <fmt/format.h>

#include "limcycle/reports/figures/figures.hpp"
#include "limcycle/reports/page/html_parts.hpp"

namespace limcycle {
namespace {

bool is_tall(const std::string& id) {
  return id == "nyquist" || id == "time" || id == "multipliers" || id.starts_with("work-");
}

std::string figure_html(const Figure& figure) {
  const std::string label = html_escaped(figure.heading + ". " + figure.finding);
  return fmt::format(
      "<figure>\n<h3>{0}</h3>\n<div class=\"plot{1}\" data-figure=\"{2}\" tabindex=\"0\" role=\"img\" "
      "aria-label=\"{3}\"></div>\n"
      "<figcaption>{4}</figcaption>\n<script type=\"application/json\" id=\"data-{2}\">{5}</script>\n</figure>\n",
      html_escaped(figure.heading), is_tall(figure.id) ? " tall" : "", figure.id, label, html_escaped(figure.finding),
      figure.data);
}

}  // namespace

std::string figure_data(const std::string& json) {
  std::string safe;  // "</script>" and "<!--" must not appear inside the page's script element
  for (const char c : json) safe += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return safe;
}

std::string figures_html(const std::vector<Figure>& figures, bool hint) {
  if (figures.empty()) return "";
  std::string out;
  if (hint)
    out =
        "<p class=\"hint\">Drag to pan, drag with Shift to zoom, double-click to reset the view. Keys of a focused "
        "figure: arrows pan, + and − zoom, a shows all, 0 resets the view.</p>\n<noscript><p>The figures need "
        "JavaScript; the captions describe them.</p></noscript>\n";
  for (const auto& figure : figures) out += figure_html(figure);
  return out;
}

}  // namespace limcycle
