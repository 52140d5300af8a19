#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/continuation/continue.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/page/html_parts.hpp"

namespace limcycle {
namespace {

constexpr std::string_view branch_style =
    "text{font:12px system-ui,sans-serif;fill:#59636e}.frame{fill:none;stroke:#8b949e;stroke-opacity:.5}"
    ".stable{fill:none;stroke:#2f81c7;stroke-width:2}.unstable{fill:none;stroke:#2f81c7;stroke-width:2;"
    "stroke-dasharray:6 4}.fold{fill:#d9661f}.stability{fill:none;stroke:#d9661f;stroke-width:2}"
    ".end{fill:#59636e}.title{font-size:14px;font-weight:600}";

/// One axis, linear or logarithmic.
struct Axis {
  double low = infinite, high = -infinite;
  bool logarithmic = false;

  void include(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void settle() {
    logarithmic = low > 0.0 && high > 10.0 * low;
    // A nearly constant quantity is drawn as such, not as a picture of its rounding.
    const double middle = 0.5 * (low + high), least = middle != 0.0 ? 0.02 * std::abs(middle) : 1.0;
    if (high - low < least) {
      low = middle - 0.5 * least;
      high = middle + 0.5 * least;
    }
  }
  double share(double value) const {
    const double at = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    return std::clamp(at, -0.05, 1.05);
  }
  std::string range(const std::string& unit) const {
    return with_digits(low, 3) + " to " + Units::attach(with_digits(high, 3), unit) + (logarithmic ? " (log)" : "");
  }
};

struct BranchPanel {
  double left, top, width, height;
  Axis x, y;
  std::string at(double px, double py) const {
    return fmt::format("{:.1f},{:.1f}", left + width * x.share(px), top + height * (1.0 - y.share(py)));
  }
};

using OfPoint = double (*)(const BranchPoint&);

/// The branch as runs of equal stability; adjacent runs share their border point.
std::string curves(const BranchPanel& panel, const Branch& branch, OfPoint quantity) {
  std::string out, d;
  std::optional<bool> kind;
  const auto flush = [&] {
    if (!d.empty())
      out += fmt::format("<path class=\"{}\" d=\"{}\"/>\n", kind.value_or(false) ? "stable" : "unstable", d);
    d.clear();
  };
  std::string last;
  for (const auto& point : branch.points) {
    const std::string here = panel.at(point.parameter, quantity(point));
    if (point.cycle.stable && kind && *point.cycle.stable != *kind) {
      flush();
      d = "M" + last;
    }
    if (point.cycle.stable) kind = point.cycle.stable;
    d += (d.empty() ? "M" : " L") + here;
    last = here;
  }
  flush();
  return out;
}

std::string marks(const BranchPanel& panel, const Branch& branch, OfPoint quantity) {
  std::string out;
  for (const auto& event : branch.events) {
    const BranchPoint& point = branch.points[event.point];
    const std::string at = panel.at(point.parameter, quantity(point));
    const auto comma = at.find(',');
    out += fmt::format(
        "<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{}\"><title>{}</title></circle>\n", to_string(event.type),
        at.substr(0, comma), at.substr(comma + 1), event.type == BranchEvent::Type::end ? 3 : 5,
        html_escaped(fmt::format("{} at {}: {}", to_string(event.type), with_digits(event.parameter, 8), event.why)));
  }
  return out;
}

std::string drawn(BranchPanel panel, const ContinueReport& report, OfPoint quantity, const std::string& name,
                  const std::string& unit, const std::string& below) {
  for (const auto& branch : report.found.branches)
    for (const auto& point : branch.points) {
      panel.x.include(point.parameter);
      panel.y.include(quantity(point));
    }
  panel.x.settle();
  panel.y.settle();
  std::string out = fmt::format(
      "<rect class=\"frame\" x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"{2:.1f}\" height=\"{3:.1f}\"/>\n"
      "<text x=\"{0:.1f}\" y=\"{4:.1f}\">{5}</text>\n<text x=\"{6:.1f}\" y=\"{7:.1f}\" "
      "text-anchor=\"end\">{8}</text>\n",
      panel.left, panel.top, panel.width, panel.height, panel.top - 5.0,
      html_escaped(name + ": " + panel.y.range(unit)), panel.left + panel.width, panel.top + panel.height + 14.0,
      html_escaped(below + " " + panel.x.range("")));
  for (const auto& branch : report.found.branches)
    if (branch.points.size() > 1) out += curves(panel, branch, quantity);
  for (const auto& branch : report.found.branches) out += marks(panel, branch, quantity);
  return out;
}

}  // namespace

std::string continue_picture(const ContinueReport& report, const Units& units) {
  const bool any = !report.found.branches.empty();
  const std::string words = continue_answer(report, units);
  std::string body;
  if (any) {
    body += drawn(
        {10, 50, 360, 250, {}, {}}, report, [](const BranchPoint& p) { return p.cycle.amplitude; }, "amplitude",
        units.y, report.path);
    body += drawn(
        {390, 50, 360, 250, {}, {}}, report, [](const BranchPoint& p) { return p.cycle.period; }, "period", "s",
        report.path);
    body +=
        "<text x=\"10\" y=\"335\">stable: solid; unstable: dashed; filled circle: fold; open circle: change of "
        "stability; small: end</text>\n";
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 760 {0}\" width=\"760\" height=\"{0}\" role=\"img\" "
      "aria-label=\"{1}\">\n<style>{2}</style>\n<text class=\"title\" x=\"10\" y=\"20\">{3}</text>\n{4}</svg>\n",
      any ? 345 : 36, html_escaped(words), branch_style, html_escaped(any ? "Limit cycles over " + report.path : words),
      body);
}

}  // namespace limcycle
