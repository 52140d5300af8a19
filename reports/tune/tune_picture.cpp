#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "limcycle/reports/figures/drawing/svg_parts.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/page/html_parts.hpp"
#include "limcycle/reports/tune/tune.hpp"

namespace limcycle {
namespace {

constexpr std::string_view tune_style =
    "text{font:11px system-ui,sans-serif;fill:#59636e}.title{font-size:14px;font-weight:600}.frame{fill:none;stroke:"
    "#8b949e;stroke-opacity:.6}.end{text-anchor:end}.middle{text-anchor:middle}.way{stroke:#8b949e;stroke-width:1.2;"
    "stroke-dasharray:3 "
    "3}.open{fill:none;stroke:#8b949e}.own{fill:none;stroke:#24292f;stroke-width:1.5}.best{fill:none;"
    "stroke:#24292f;stroke-width:2}";
constexpr double tune_top = 36.0, tune_left = 30.0, tune_gap = 40.0, tune_between_rows = 44.0;

/// A scale of a panel: a number between its bounds, or the cost.
struct TuneAxis {
  std::string name;
  double low = 0.0, high = 1.0;
  bool logarithmic = false;

  /// 0 to 1.
  double share(double value) const {
    const double at = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    return std::isfinite(at) ? std::clamp(at, 0.0, 1.0) : 0.0;
  }
};

std::string outcome_colour(TuneOutcome outcome) {
  switch (outcome) {
    case TuneOutcome::hunts:
      return "#c8442f";
    case TuneOutcome::neutral:
      return "#d9a7c7";
    case TuneOutcome::diverges:
      return "#3b2f45";
    case TuneOutcome::unstable:
      return "#8a5a2b";
    case TuneOutcome::fragile:
      return "#e79c9c";
    case TuneOutcome::above_limit:
      return "#eda352";
    case TuneOutcome::undecided:
      return "#b9bec4";
    default:
      return "none";
  }
}

class TunePicture {
 public:
  TunePicture(const TuneReport& report, const Units& units)
      : report_(report), units_(units), names_(tune_names(report)) {
    for (const TunePoint& point : report.points)
      if (const auto cost = cost_of(point); cost && point.outcome == TuneOutcome::feasible) {
        cost_.low = costs_known_ ? std::min(cost_.low, *cost) : *cost;
        cost_.high = costs_known_ ? std::max(cost_.high, *cost) : *cost;
        costs_known_ = true;
      }
    cost_.name = tune_cost_name(report.minimised);
    cost_.logarithmic = cost_.low > 0.0 && cost_.high > 10.0 * cost_.low;
    const std::size_t n = report.numbers.size();
    side_ = n <= 2 ? 420.0 : 216.0;
    for (std::size_t i = 0; i < n; ++i) {
      const TuneNumber& one = report.numbers[i];
      axes_.push_back({names_[i], one.low, one.high, one.low * one.high > 0.0});
    }
  }

  std::string svg() const {
    std::string body;
    std::size_t panel = 0;
    const std::size_t n = axes_.size();
    if (n == 1) body += panel_at(panel++, 0, std::nullopt);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = i + 1; k < n; ++k) body += panel_at(panel++, i, k);
    const double columns = n <= 2 ? 1.0 : 3.0, rows = std::ceil(static_cast<double>(panel) / columns);
    const double width = std::max(columns * (side_ + tune_gap) + tune_left, 480.0);
    double below = tune_top + rows * (side_ + tune_between_rows);
    body += legend(below, width);
    const std::string label =
        fmt::format("{} points of the search for the least {}", report_.points.size(), cost_.name);
    return svg_picture(width, below + 6.0, label, tune_style, label, body);
  }

 private:
  std::optional<double> cost_of(const TunePoint& point) const {
    return point.costs[static_cast<std::size_t>(report_.minimised)];
  }

  struct Spot {
    double x, y;
  };
  /// Of a point in the panel; one without a cost is at the top of a panel that shows costs.
  Spot spot_of(const TunePoint& point, Spot corner, std::size_t i, std::optional<std::size_t> k) const {
    double up = 1.0;
    if (k)
      up = axes_[*k].share(point.values[*k]);
    else if (const auto cost = cost_of(point))
      up = cost_.high > cost_.low ? cost_.share(*cost) : 0.5;
    return Spot{corner.x + side_ * axes_[i].share(point.values[i]), corner.y + side_ * (1.0 - up)};
  }

  std::string dot(const TunePoint& point, Spot at) const {
    if (point.outcome == TuneOutcome::feasible) {
      const double share = cost_.high > cost_.low ? cost_.share(cost_of(point).value_or(cost_.high)) : 0.5;
      return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.5\" fill=\"{}\" stroke=\"#59636e\"/>\n", at.x, at.y,
                         colour_of_share(share));
    }
    const std::string colour = outcome_colour(point.outcome);
    if (colour == "none")
      return fmt::format("<circle class=\"open\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.2\"/>\n", at.x, at.y);
    return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", at.x, at.y, colour);
  }

  std::string panel_at(std::size_t panel, std::size_t i, std::optional<std::size_t> k) const {
    const std::size_t columns = axes_.size() <= 2 ? 1 : 3, row = panel / columns;
    const Spot corner{tune_left + static_cast<double>(panel % columns) * (side_ + tune_gap),
                      tune_top + static_cast<double>(row) * (side_ + tune_between_rows)};
    std::string out = frame(corner, axes_[i], k ? axes_[*k] : cost_);
    const auto spot = [&](const TunePoint& point) { return spot_of(point, corner, i, k); };
    for (const TuneSearch& one : report_.searches) {
      const Spot from = spot(report_.points[one.from]), to = spot(report_.points[one.to]);
      out += line_of(from.x, from.y, to.x, to.y, "way");
    }
    for (const bool feasible : {false, true})  // these last, so that no other one hides them
      for (const TunePoint& point : report_.points)
        if ((point.outcome == TuneOutcome::feasible) == feasible) out += dot(point, spot(point));
    for (const TunePoint& point : report_.points) {
      if (point.part != TunePoint::Part::own) continue;
      const Spot at = spot(point);
      out += fmt::format("<rect class=\"own\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"14\" height=\"14\"/>\n", at.x - 7.0,
                         at.y - 7.0);
    }
    if (report_.best) {
      const Spot at = spot(report_.points[*report_.best]);
      out += fmt::format("<circle class=\"best\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"9\"/>\n", at.x, at.y);
    }
    return out;
  }

  std::string frame(Spot corner, const TuneAxis& x, const TuneAxis& y) const {
    const double below = corner.y + side_ + 14.0, side = corner.x - 6.0;
    std::string out =
        fmt::format("<rect class=\"frame\" x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"{2:.1f}\" height=\"{2:.1f}\"/>\n",
                    corner.x, corner.y, side_);
    const auto scale = [](const TuneAxis& axis) {
      return html_escaped(axis.name) + (axis.logarithmic ? " (log)" : "");
    };
    out += words_at(corner.x, below, "", with_digits(x.low, 3));
    out += words_at(corner.x + 0.5 * side_, below, "middle", scale(x));
    out += words_at(corner.x + side_, below, "end", with_digits(x.high, 3));
    const auto along = [&](double at, const char* kind, const std::string& words) {
      return fmt::format("<text class=\"{}\" transform=\"translate({:.1f} {:.1f}) rotate(-90)\">{}</text>\n", kind,
                         side, at, words);
    };
    return out + along(corner.y + side_, "", with_digits(y.low, 3)) +
           along(corner.y + 0.5 * side_, "middle", scale(y)) + along(corner.y, "end", with_digits(y.high, 3));
  }

  /// From `y` down, which becomes its end.
  std::string legend(double& y, double width) const {
    std::string out;
    double x = tune_left;
    const auto entry = [&](const std::string& mark, const std::string& words) {
      const double wide = 26.0 + 6.0 * static_cast<double>(words.size());
      if (x > tune_left && x + wide > width) {
        x = tune_left;
        y += 18.0;
      }
      out += fmt::format("<g transform=\"translate({:.1f} {:.1f})\">{}</g>\n", x + 8.0, y - 4.0, mark) +
             words_at(x + 20.0, y, "", html_escaped(words));
      x += wide;
    };
    const auto filled = [](const std::string& colour, double r) {
      return fmt::format(R"(<circle r="{:.1f}" fill="{}" stroke="#59636e" stroke-width=".5"/>)", r, colour);
    };
    if (costs_known_) {
      entry(filled(colour_of_share(0.0), 4.5), "does not hunt, " + tune_cost_in_words(cost_.low, report_, units_));
      entry(filled(colour_of_share(1.0), 4.5), tune_cost_in_words(cost_.high, report_, units_));
    }
    std::set<TuneOutcome> seen;
    for (const TunePoint& point : report_.points) seen.insert(point.outcome);
    for (const TuneOutcome outcome : seen) {
      if (outcome == TuneOutcome::feasible) continue;
      const std::string colour = outcome_colour(outcome);
      entry(colour == "none" ? R"(<circle class="open" r="2.2"/>)" : filled(colour, 3.0), outcome_in_words(outcome));
    }
    if (std::ranges::any_of(report_.points, [](const TunePoint& p) { return p.part == TunePoint::Part::own; }))
      entry(R"(<rect class="own" x="-6" y="-6" width="12" height="12"/>)", "as it stands");
    if (report_.best) entry(R"(<circle class="best" r="7"/>)", "tuned");
    y += 8.0;
    return out;
  }

  const TuneReport& report_;
  const Units& units_;
  const std::vector<std::string> names_;
  std::vector<TuneAxis> axes_;
  TuneAxis cost_;
  bool costs_known_ = false;
  double side_ = 216.0;
};

}  // namespace

std::string tune_picture(const TuneReport& report, const Units& units) {
  return report.points.empty() ? std::string() : TunePicture(report, units).svg();
}

}  // namespace limcycle
