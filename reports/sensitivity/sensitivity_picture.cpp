#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "limcycle/reports/figures/drawing/svg_parts.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/sensitivity/sensitivity.hpp"

namespace limcycle {
namespace {

constexpr double chart_width = 760.0, bar_pitch = 18.0, label_width = 190.0;
constexpr std::string_view chart_style =
    "text{font:11px system-ui,sans-serif;fill:#59636e}.title{font-size:14px;font-weight:600}.end{text-anchor:end}"
    ".middle{text-anchor:middle}.axis{stroke:#8b949e;stroke-opacity:.6;fill:none}.up{fill:#c8442f}.down{fill:#2f81c7}"
    ".first{fill:#2f81c7}.total{fill:#eda352}.interval{stroke:#1f2328;stroke-opacity:.7;stroke-width:1.2}"
    ".hunts{fill:#c8442f;fill-opacity:.45}.still{fill:#5ca66a;fill-opacity:.45}.line{fill:none;stroke-width:1.5}";

std::string svg(double height, const std::string& label, const std::string& title, const std::string& body) {
  return svg_picture(chart_width, height, label, chart_style, title, body);
}

double elasticity(const LocalSensitivity& one, double derivative, double quantity) {
  return quantity != 0.0 ? derivative * one.value / quantity : 0.0;
}

/// Bars to both sides of the middle; lengths on one scale.
std::string tornado_panel(double left, double width, double top, const std::string& heading,
                          const std::vector<double>& values, double longest) {
  const double middle = left + 0.5 * width;
  std::string out = words_at(middle, top - 8.0, "middle", heading);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double y = top + bar_pitch * static_cast<double>(i), length = 0.42 * width * std::abs(values[i]) / longest;
    const bool up = values[i] >= 0.0;
    out += fmt::format("<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"12\"/>\n",
                       up ? "up" : "down", up ? middle : middle - length, y, length);
    out += words_at(up ? middle + length + 4.0 : middle - length - 4.0, y + 10.0, up ? "" : "end",
                    with_digits(values[i], 3));
  }
  return out + line_of(middle, top - 3.0, middle, top + bar_pitch * static_cast<double>(values.size()), "axis");
}

std::string bar_with_interval(const Estimate& estimate, std::string_view kind, double left, double width, double y) {
  if (!estimate.known) return words_at(left + 3.0, y + 7.0, "", "not known");
  const double from = place(0.0, left, width, -0.1, 1.1), to = place(estimate.value, left, width, -0.1, 1.1);
  std::string out = fmt::format("<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"7\"/>\n", kind,
                                std::min(from, to), y, std::abs(to - from));
  if (estimate.bounded())
    out += line_of(place(estimate.low, left, width, -0.1, 1.1), y + 3.5, place(estimate.high, left, width, -0.1, 1.1),
                   y + 3.5, "interval");
  return out;
}

constexpr std::string_view line_colours[] = {"#2f81c7", "#c8442f", "#5ca66a", "#eda352",
                                             "#7a4fa3", "#1f9e9e", "#8a6d3b"};

/// Total indices over the number of base samples.
std::string convergence_panel(const OutputSensitivity& output, double left, double top, double width, double height) {
  std::string out = fmt::format("<rect class=\"axis\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>\n",
                                left, top, width, height);
  const std::size_t steps = output.convergence.size();
  if (steps < 2) return out + words_at(left + 6.0, top + 16.0, "", "too few samples to show whether they settle");
  const auto x = [&](std::size_t k) { return left + width * static_cast<double>(k) / static_cast<double>(steps - 1); };
  for (std::size_t i = 0; i < output.sobol.parameters.size(); ++i) {
    std::string d;
    for (std::size_t k = 0; k < steps; ++k) {
      const Estimate& total = output.convergence[k].parameters[i].total;
      if (!total.known) continue;
      d += fmt::format("{}{:.1f},{:.1f}", d.empty() ? "M" : " L", x(k),
                       top + height - place(total.value, 0.0, height, -0.1, 1.1));
    }
    if (!d.empty())
      out +=
          fmt::format("<path class=\"line\" stroke=\"{}\" d=\"{}\"/>\n", line_colours[i % std::size(line_colours)], d);
  }
  out += words_at(left, top + height + 13.0, "", fmt::format("{} samples", output.convergence.front().samples));
  out += words_at(left + width, top + height + 13.0, "end", std::to_string(output.convergence.back().samples));
  return out;
}

}  // namespace

std::string tornado_picture(const SensitivityReport& report) {
  if (!report.cycle) return "";
  struct Bar {
    std::string name;
    double amplitude, period;
  };
  std::vector<Bar> bars;
  double longest = 0.0;
  for (const auto& one : report.local) {
    Bar bar{short_path(one.path), elasticity(one, one.amplitude, report.cycle->amplitude),
            elasticity(one, one.period, report.cycle->period)};
    if (!std::isfinite(bar.amplitude) || !std::isfinite(bar.period)) continue;
    if (std::max(std::abs(bar.amplitude), std::abs(bar.period)) < 1e-9) continue;
    longest = std::max({longest, std::abs(bar.amplitude), std::abs(bar.period)});
    bars.push_back(std::move(bar));
  }
  if (bars.empty()) return "";
  std::ranges::stable_sort(bars, std::ranges::greater(),
                           [](const Bar& bar) { return std::max(std::abs(bar.amplitude), std::abs(bar.period)); });
  const double top = 62.0;
  std::string body;
  std::vector<double> amplitudes, periods;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    body += words_at(label_width - 8.0, top + bar_pitch * static_cast<double>(i) + 10.0, "end", bars[i].name);
    amplitudes.push_back(bars[i].amplitude);
    periods.push_back(bars[i].period);
  }
  const double width = 0.5 * (chart_width - label_width - 10.0);
  body += tornado_panel(label_width, width, top, "amplitude, % per %", amplitudes, longest);
  body += tornado_panel(label_width + width, width, top, "period, % per %", periods, longest);
  return svg(top + bar_pitch * static_cast<double>(bars.size()) + 12.0, sensitivity_answer(report),
             "Elasticities of the cycle: per cent for each per cent of a number", body);
}

std::string threshold_picture(const ThresholdSensitivity& threshold) {
  std::vector<std::pair<std::string, double>> bars;
  double longest = 0.0;
  for (const auto& one : threshold.numbers) {
    const double bar = threshold.at != 0.0 ? one.by.value * one.value / threshold.at : 0.0;
    if (!one.why.empty() || std::abs(one.by.value) <= one.by.error || std::abs(bar) < 1e-9) continue;
    longest = std::max(longest, std::abs(bar));
    bars.emplace_back(short_path(one.path), bar);
  }
  if (bars.empty()) return "";
  std::ranges::stable_sort(bars, std::ranges::greater(), [](const auto& bar) { return std::abs(bar.second); });
  const double top = 62.0;
  std::string body;
  std::vector<double> values;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    body += words_at(label_width - 8.0, top + bar_pitch * static_cast<double>(i) + 10.0, "end", bars[i].first);
    values.push_back(bars[i].second);
  }
  body += tornado_panel(label_width, chart_width - label_width - 10.0, top, "% per %", values, longest);
  return svg(top + bar_pitch * static_cast<double>(bars.size()) + 12.0, threshold_sentence(threshold),
             "Elasticities of the threshold of " + short_path(threshold.path), body);
}

std::string indices_picture(const SensitivityReport& report, const OutputSensitivity& output) {
  const auto& parameters = report.spread.parameters;
  const double top = 56.0, left = label_width, width = 300.0, height = 26.0 * static_cast<double>(parameters.size()),
               right = left + width + 40.0;
  std::string body = words_at(place(0.0, left, width, -0.1, 1.1), top - 10.0, "middle", "0") +
                     words_at(place(1.0, left, width, -0.1, 1.1), top - 10.0, "middle", "1") +
                     words_at(left + 0.5 * width, top - 10.0, "middle", "first (blue) and total (orange) index");
  std::string label = "Sobol indices of " + output.output + ":";
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const SobolIndex& index = output.sobol.parameters[i];
    const double y = top + 26.0 * static_cast<double>(i);
    body += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"8\" height=\"8\" fill=\"{}\"/>\n", left - 12.0,
                        y + 4.0, line_colours[i % std::size(line_colours)]);
    body += words_at(left - 18.0, y + 12.0, "end", short_path(parameters[i].path));
    body += bar_with_interval(index.first, "first", left, width, y) +
            bar_with_interval(index.total, "total", left, width, y + 9.0);
    if (index.total.known) label += fmt::format(" {} {:.2f},", short_path(parameters[i].path), index.total.value);
  }
  label.back() = '.';
  const double zero = place(0.0, left, width, -0.1, 1.1);
  body += line_of(zero, top - 4.0, zero, top + height, "axis");
  body += words_at(right, top - 10.0, "", "total index over the number of samples") +
          convergence_panel(output, right, top, chart_width - right - 12.0, std::max(60.0, height - 8.0));
  return svg(top + std::max(84.0, height + 24.0), label, "Sobol indices of " + output.output, body);
}

std::string scatter_picture(const SensitivityReport& report) {
  const auto& parameters = report.spread.parameters;
  if (report.sample.empty() || parameters.empty()) return "";
  constexpr double side = 170.0, pitch = 186.0;
  constexpr std::size_t most = 600;
  double highest = 0.0;
  for (const auto& row : report.sample)
    if (row[parameters.size() + 1] > highest) highest = row[parameters.size() + 1];
  std::string body;
  const std::size_t step = (report.sample.size() + most - 1) / most;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::size_t line = i / 4;
    const double left = 12.0 + pitch * static_cast<double>(i % 4), top = 48.0 + 212.0 * static_cast<double>(line);
    double low = infinite, high = -infinite;
    for (const auto& row : report.sample) {
      low = std::min(low, row[i]);
      high = std::max(high, row[i]);
    }
    if (!(high > low)) high = low + 1.0;
    const bool logarithmic = parameters[i].distribution == Distribution::log_uniform;
    const auto across = [&](double value) {
      return logarithmic ? place(std::log(value / low), left, side, 0.0, std::log(high / low))
                         : place(value, left, side, low, high);
    };
    body += fmt::format("<rect class=\"axis\" x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"{2:.0f}\" height=\"{2:.0f}\"/>\n",
                        left, top, side);
    for (std::size_t k = 0; k < report.sample.size(); k += step) {
      const auto& row = report.sample[k];
      const double hunts = row[parameters.size()], amplitude = row[parameters.size() + 1];
      if (!(hunts >= 0.0)) continue;  // no answer
      const double y = hunts > 0.0 ? place(amplitude, 0.0, side, 0.0, highest) : 0.0;
      body += fmt::format(R"(<circle class="{}" cx="{:.1f}" cy="{:.1f}" r="2"/>)", hunts > 0.0 ? "hunts" : "still",
                          across(row[i]), top + side - y);
    }
    body += "\n" + words_at(left, top - 5.0, "", short_path(parameters[i].path) + (logarithmic ? " (log)" : "")) +
            words_at(left, top + side + 13.0, "", with_digits(low, 3)) +
            words_at(left + side, top + side + 13.0, "end", with_digits(high, 3));
  }
  const std::size_t lines = (parameters.size() + 3) / 4;
  const double height = 56.0 + 212.0 * static_cast<double>(lines);
  return svg(
      height, "Amplitude of hunting over each parameter, one point for each loop of the sample",
      fmt::format("Amplitude over each parameter, 0 to {} (red: hunts, green: does not)", with_digits(highest, 3)),
      body);
}

}  // namespace limcycle
