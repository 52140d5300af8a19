#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/figures/drawing/svg_parts.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/identify/identify.hpp"

namespace limcycle {
namespace {

constexpr std::string_view identify_style =
    "text{font:12px system-ui,sans-serif;fill:#59636e}.frame{fill:none;stroke:#8b949e;stroke-opacity:.5}"
    ".dot{fill:#8b949e;fill-opacity:.55}.law{fill:none;stroke:#d9661f;stroke-width:2;stroke-linejoin:round}"
    ".zero{stroke:#8b949e;stroke-opacity:.4;stroke-dasharray:3 3}.right{text-anchor:end}"
    ".title{font-size:14px;font-weight:600}";
constexpr double record_width = 350.0, record_height = 190.0, gap = 20.0, head_height = 60.0, foot_height = 56.0;
constexpr double strip_height = 48.0, strip_gap = 20.0;  ///< of the residuals, below the curve
constexpr std::size_t most_points = 700;

/// What a panel shows: the force over something.
struct PanelCurve {
  std::vector<double> x, measured, fitted;
  std::string over;       ///< "velocity", with its unit
  bool by_size = false;   ///< x is the logarithm of a speed
  bool from_zero = true;  ///< the axis includes 0
};

PanelCurve curve_of(const PreparedRecord& record, const RecordFit& fit) {
  PanelCurve curve;
  for (const auto& row : record.compared) curve.measured.push_back(row.measured);
  curve.fitted = fit.fitted;
  curve.from_zero = record.quantity != MeasuredQuantity::position;
  switch (record.kind) {
    case RecordKind::pre_sliding:
      for (const auto& row : record.compared) curve.x.push_back(row.x);
      curve.over = "position, m";
      break;
    case RecordKind::break_away:
    case RecordKind::free:
    case RecordKind::free_decay:
      for (const auto& row : record.compared) curve.x.push_back(row.t);
      curve.over = "time, s";
      break;
    case RecordKind::lag:
      for (const auto& row : record.compared) curve.x.push_back(row.v);
      curve.over = "velocity, m/s";
      break;
    case RecordKind::steady_velocity:
      // Both directions over the speed, as the curve that a law has; its low speeds need a logarithm.
      for (std::size_t i = 0; i < record.compared.size(); ++i) {
        const double v = record.compared[i].v, sign = v < 0.0 ? -1.0 : 1.0;
        curve.x.push_back(std::log10(std::abs(v)));
        curve.measured[i] *= sign;
        curve.fitted[i] *= sign;
      }
      curve.over = "speed, m/s (logarithmic); forces against the motion";
      curve.by_size = true;
      break;
  }
  return curve;
}

struct RecordFrame {
  double left, up, x_low, x_high, y_low, y_high;

  double px(double x) const { return place(x, left, record_width, x_low, x_high); }
  double py(double y) const { return up + record_height - place(y, 0.0, record_height, y_low, y_high); }
};

RecordFrame frame_of(const PanelCurve& curve, double left, double up) {
  const auto [x_low, x_high] = std::ranges::minmax(curve.x);
  double y_low = 0.0, y_high = 0.0;
  if (!curve.from_zero) y_low = y_high = curve.measured.front();
  for (const auto* values : {&curve.measured, &curve.fitted}) {
    const auto [low, high] = std::ranges::minmax(*values);
    y_low = std::min(y_low, low);
    y_high = std::max(y_high, high);
  }
  const double x_margin = x_high > x_low ? 0.03 * (x_high - x_low) : 1.0, y_margin = 0.06 * (y_high - y_low);
  return {left, up, x_low - x_margin, x_high + x_margin, y_low - y_margin, y_high + y_margin};
}

/// The differences that the law leaves, on the axis of the panel above: what they show beyond noise, it misses.
std::string residual_strip(const PanelCurve& curve, const RecordFrame& frame, std::string_view unit) {
  const double up = frame.up + record_height + strip_gap;
  constexpr double room = 1.1;
  double most = 0.0;
  for (std::size_t i = 0; i < curve.x.size(); ++i) most = std::max(most, std::abs(curve.measured[i] - curve.fitted[i]));
  const auto height_of = [&](double left) {
    return up + strip_height - place(left, 0.0, strip_height, -room * most, room * most);
  };
  std::string out =
      fmt::format("<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n", frame.left,
                  up, record_width, strip_height);
  out += words_at(frame.left, up - 5.0, "",
                  fmt::format("measured less fitted: at most {} {}", with_digits(most, 2), unit));
  if (!(most > 0.0)) return out;
  out += line_of(frame.left, height_of(0.0), frame.left + record_width, height_of(0.0), "zero");
  const std::size_t every = curve.x.size() / most_points + 1;
  for (std::size_t i = 0; i < curve.x.size(); i += every)
    out += fmt::format("<circle class=\"dot\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.5\"/>\n", frame.px(curve.x[i]),
                       height_of(curve.measured[i] - curve.fitted[i]));
  return out;
}

std::string panel(const PreparedRecord& record, const RecordFit& fit, double left, double up) {
  const PanelCurve curve = curve_of(record, fit);
  const RecordFrame frame = frame_of(curve, left, up);
  std::string out =
      fmt::format("<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n", left, up,
                  record_width, record_height);
  if (frame.y_low <= 0.0 && frame.y_high >= 0.0)
    out += line_of(left, frame.py(0.0), left + record_width, frame.py(0.0), "zero");
  const std::size_t every = curve.x.size() / most_points + 1;
  for (std::size_t i = 0; i < curve.x.size(); i += every)
    out += fmt::format("<circle class=\"dot\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.8\"/>\n", frame.px(curve.x[i]),
                       frame.py(curve.measured[i]));
  std::vector<std::size_t> order(curve.x.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  if (curve.by_size) std::ranges::stable_sort(order, {}, [&](std::size_t i) { return curve.x[i]; });
  std::string d;
  for (std::size_t i = 0; i < order.size(); i += curve.by_size ? 1 : every)
    d += fmt::format("{}{:.1f},{:.1f}", d.empty() ? "M" : " L", frame.px(curve.x[order[i]]),
                     frame.py(curve.fitted[order[i]]));
  out += fmt::format("<path class=\"law\" d=\"{}\"/>\n", d);
  const auto unit = unit_of(record.quantity);
  const std::string error = with_digits(fit.error, 2), largest = with_digits(record.size, 3);
  out +=
      words_at(left, up - 6.0, "",
               record.motion ? fmt::format("{}: error {} of {} {}", record_label(record), error, largest, unit)
                             : fmt::format("{}: error {} N; largest force {} N", record_label(record), error, largest));
  const auto edge = [&](double x) { return with_digits(curve.by_size ? std::pow(10.0, x) : x, 2); };
  const auto [low, high] = std::ranges::minmax(curve.x);
  const double foot = up + record_height + strip_gap + strip_height;
  out += residual_strip(curve, frame, unit);
  out += words_at(left, foot + 15.0, "", edge(low));
  out += words_at(left + record_width, foot + 15.0, "right", edge(high));
  out += words_at(left, foot + 31.0, "", curve.over);
  return out;
}

}  // namespace

std::string identify_picture(const IdentifyReport& report) {
  const IdentifiedLaw* law = shown_law(report);
  if (law == nullptr || law->records.empty())
    return svg_picture(760, 36, "no law was fitted", identify_style, "No law was fitted", "");
  std::string body =
      words_at(10.0, 38.0, "",
               report.shooting ? "dots: measured; line: the fitted law, driven by the measured motion or moving freely"
                               : "dots: measured friction force; line: the fitted law, driven by the measured motion");
  const std::size_t rows = (law->records.size() + 1) / 2;
  constexpr double whole_height = record_height + strip_gap + strip_height + foot_height;
  for (std::size_t r = 0; r < law->records.size(); ++r) {
    const std::size_t row = r / 2, column = r % 2;
    body += panel(report.records[r], law->records[r], 10.0 + static_cast<double>(column) * (record_width + gap),
                  head_height + static_cast<double>(row) * whole_height);
  }
  const std::string title = fmt::format("{}: error on rows that it was not fitted to, {} of {}", law->law.kind(),
                                        as_percent(law->held_out), largest_measured(report));
  return svg_picture(20.0 + 2.0 * record_width + gap, head_height + static_cast<double>(rows) * whole_height, title,
                     identify_style, title, body);
}

}  // namespace limcycle
