#include "limcycle/reports/figures/blocks/drawn_blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/page/html_parts.hpp"

namespace limcycle {
namespace {

constexpr double column_width = 7.0;  // of a letter, a wide estimate, as fonts differ

constexpr std::string_view diagram_style =
    ".diagram-line,.diagram-box,.diagram-sum{fill:none;stroke:currentColor;stroke-width:1.4}"
    ".diagram-head,.diagram-node{fill:currentColor;stroke:none}"
    ".diagram-words{font:12px system-ui,\"DejaVu Sans\",sans-serif;fill:currentColor}"
    ".diagram-name{font-weight:600}.diagram-centred{text-anchor:middle}.diagram-end{text-anchor:end}"
    "@media print{.diagram{min-width:0!important}}";

}  // namespace

double width_of(const std::string& words) { return column_width * static_cast<double>(display_width(words)); }

PlacedBlock sized(BlockWords words) {
  PlacedBlock block{std::move(words), 0.0, 0.0, 0.0, 0.0};
  block.width = 1.08 * width_of(block.words.title);  // bold
  double height = block_line_height;
  for (const auto& line : block.words.lines) {
    block.width = std::max(block.width, width_of(line.words));
    height += line.bar ? 5.0 : block_line_height;
  }
  block.width += 20.0;
  block.height = height + 14.0;
  return block;
}

std::string words_in(double x, double y, const std::string& words, std::string_view kind) {
  return fmt::format("<text class=\"diagram-words{}{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", kind.empty() ? "" : " ",
                     kind, x, y, html_escaped(words));
}

std::string drawn(const PlacedBlock& block) {
  std::string out = "<g class=\"diagram-block\"><title>" +
                    html_escaped(block.words.whole + ". " + block.words.equation) + "</title>\n";
  out += fmt::format(
      "<rect class=\"diagram-box\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" rx=\"3\" "
      "pointer-events=\"all\"/>\n",
      block.x, block.y, block.width, block.height);
  double y = block.y + block_line_height;
  out += words_in(block.x + 10.0, y, block.words.title, "diagram-name");
  for (const auto& line : block.words.lines) {
    y += line.bar ? 5.0 : block_line_height;
    if (line.bar)
      out += fmt::format("<path class=\"diagram-line\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>\n", block.x + 10.0, y + 1.0,
                         block.right() - 10.0);
    else
      out += words_in(line.centred ? block.middle() : block.x + 10.0, y, line.words,
                      line.centred ? "diagram-centred" : "");
  }
  return out + "</g>\n";
}

std::string arrow(const std::vector<Spot>& corners) {
  std::string path;
  for (const auto& spot : corners) path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", spot.x, spot.y);
  const Spot end = corners.back(), before = corners[corners.size() - 2];
  const double length = std::hypot(end.x - before.x, end.y - before.y);
  const double ux = (end.x - before.x) / length, uy = (end.y - before.y) / length;
  return fmt::format(
      "<path class=\"diagram-line\" d=\"{}\"/>\n<path class=\"diagram-head\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} "
      "{:.1f}Z\"/>\n",
      path, end.x, end.y, end.x - 8.0 * ux + 3.5 * uy, end.y - 8.0 * uy - 3.5 * ux, end.x - 8.0 * ux - 3.5 * uy,
      end.y - 8.0 * uy + 3.5 * ux);
}

std::string circle_at(Spot spot) {
  return fmt::format("<circle class=\"diagram-sum\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.0f}\"/>\n", spot.x, spot.y,
                     sum_radius);
}

std::string node_at(Spot spot) {
  return fmt::format("<circle class=\"diagram-node\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\"/>\n", spot.x, spot.y);
}

std::string framed_diagram(const std::string& body, double width, double height, const std::string& label) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"diagram\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "style=\"display:block;width:100%;max-width:{0:.0f}px;min-width:{2:.0f}px;height:auto\" role=\"img\" "
      "aria-label=\"{3}\">\n<style>{4}</style>\n{5}</svg>\n",
      width, height, std::min(width, std::max(0.85 * width, 300.0)), html_escaped(label), diagram_style, body);
}

}  // namespace limcycle
