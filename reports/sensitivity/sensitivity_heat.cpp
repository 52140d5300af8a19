#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "limcycle/reports/figures/drawing/svg_parts.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/page/html_parts.hpp"
#include "limcycle/reports/sensitivity/sensitivity.hpp"

namespace limcycle {
namespace {

constexpr std::string_view heat_style =
    "text{font:11px system-ui,sans-serif;fill:#59636e}.title{font-size:14px;font-weight:600}.end{text-anchor:end}"
    ".middle{text-anchor:middle}.frame{stroke:#8b949e;stroke-opacity:.6;fill:none}.light{fill:#fff;text-anchor:middle}"
    ".none{fill:#8b949e;fill-opacity:.25}.faint{text-anchor:middle;fill-opacity:.5}";
constexpr double heat_width = 760.0;
constexpr std::size_t bins = 10;  ///< to each side of a heat map of two parameters

std::string cell_of(double left, double top, double width, double height, double share, const std::string& tip) {
  return fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" fill="{}"><title>{}</title></rect>)",
                     left, top, width, height, colour_of_share(share), html_escaped(tip));
}

/// Results of the loops in one bin.
struct Bin {
  std::size_t decided = 0, hunting = 0;
};
using Bins = std::array<std::array<Bin, bins>, bins>;  // [row from below][column]

/// Index of the bin; all bins are equally likely.
std::size_t bin_of(const SpreadParameter& parameter, double value) {
  std::size_t bin = 0;
  while (bin + 1 < bins && value > parameter.quantile(static_cast<double>(bin + 1) / static_cast<double>(bins))) ++bin;
  return bin;
}

Bins counted(const SensitivityReport& report, std::size_t x, std::size_t y) {
  Bins all{};
  const auto& parameters = report.spread.parameters;
  for (const auto& row : report.sample) {
    const double hunts = row[parameters.size()];
    if (!(hunts >= 0.0)) continue;
    Bin& bin = all[bin_of(parameters[y], row[y])][bin_of(parameters[x], row[x])];
    ++bin.decided;
    if (hunts > 0.0) ++bin.hunting;
  }
  return all;
}

/// Ends of the bins along one side.
std::string ends_of(const SpreadParameter& parameter, std::size_t k) {
  const auto end = [&](std::size_t i) {
    return with_digits(parameter.quantile(std::clamp(static_cast<double>(i) / bins, 1e-6, 1.0 - 1e-6)), 3);
  };
  return short_path(parameter.path) + " " + end(k) + " to " + end(k + 1);
}

}  // namespace

std::string interactions_picture(const SensitivityReport& report, const OutputSensitivity& output) {
  const auto& parameters = report.spread.parameters;
  const std::size_t n = parameters.size();
  if (output.sobol.interactions.empty()) return "";
  const double left = 190.0, top = 44.0, width = std::min(90.0, (heat_width - left - 12.0) / static_cast<double>(n));
  constexpr double height = 26.0;
  std::string body;
  const auto cell = [&](std::size_t row, std::size_t column, const Estimate& share, const std::string& tip) {
    const double x = left + width * static_cast<double>(column), y = top + height * static_cast<double>(row);
    if (!share.known) {
      body += fmt::format(R"(<rect class="none" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"/>)", x, y, width,
                          height);
      return;
    }
    const bool told = !share.bounded() || share.low > 0.0;  // distinguishable from zero
    const std::string interval = share.bounded() ? fmt::format(" ({:.3f} to {:.3f})", share.low, share.high) : "";
    body += cell_of(x, y, width, height, told ? share.value : 0.0, tip + ": " + with_digits(share.value, 3) + interval);
    body += words_at(x + 0.5 * width, y + 17.0,
                     told && share.value > 0.4 ? "light"
                     : told                    ? "middle"
                                               : "faint",
                     fmt::format("{:.2f}", std::abs(share.value) < 0.005 ? 0.0 : share.value));
  };
  std::string label = "Shares of the variance of " + output.output + ", alone and in pairs.";
  double largest = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    body += words_at(left - 8.0, top + height * static_cast<double>(i) + 17.0, "end", short_path(parameters[i].path));
    cell(i, i, output.sobol.parameters[i].first, parameters[i].path + " alone");
  }
  for (const auto& pair : output.sobol.interactions) {
    const std::string both = parameters[pair.one].path + " with " + parameters[pair.other].path;
    cell(pair.other, pair.one, pair.share, both);
    if (pair.share.known && pair.share.bounded() && pair.share.low > 0.0 && pair.share.value > largest) {
      largest = pair.share.value;
      label = fmt::format("Shares of the variance of {}: the largest of a pair is {:.2f}, {}.", output.output, largest,
                          both);
    }
  }
  for (std::size_t i = 0; i < n; ++i)  // below the matrix, alternating between lines, so that names do not touch
    body += words_at(left + width * (static_cast<double>(i) + 0.5),
                     top + height * static_cast<double>(n) + 14.0 + 13.0 * static_cast<double>(i % 3), "middle",
                     short_path(parameters[i].path));
  return svg_picture(heat_width, top + height * static_cast<double>(n) + 52.0, label, heat_style,
                     "Shares of the variance of " + output.output + ": alone (diagonal) and in pairs", body);
}

std::string hunting_heat_picture(const SensitivityReport& report) {
  const auto& parameters = report.spread.parameters;
  if (!report.global || parameters.size() < 2 || report.sample.size() < 4 * bins) return "";
  if (report.global->outputs.front().sobol.parameters.empty()) return "";
  const auto order = report.global->outputs.front().sobol.by_total();
  if (!report.global->outputs.front().sobol.parameters[order[1]].total.known) return "";
  const std::size_t x = order[0], y = order[1];
  const Bins all = counted(report, x, y);
  constexpr double side = 30.0, left = 190.0, top = 44.0, extent = side * static_cast<double>(bins);
  std::string body;
  for (std::size_t row = 0; row < bins; ++row)
    for (std::size_t column = 0; column < bins; ++column) {
      const Bin& bin = all[row][column];
      const double at = left + side * static_cast<double>(column),
                   y_at = top + extent - side * static_cast<double>(row + 1);
      if (bin.decided == 0) continue;
      body += cell_of(at, y_at, side, side, static_cast<double>(bin.hunting) / static_cast<double>(bin.decided),
                      fmt::format("{}, {}: {} of {} hunt", ends_of(parameters[x], column), ends_of(parameters[y], row),
                                  bin.hunting, bin.decided));
    }
  const auto end = [](const SpreadParameter& parameter, double at) { return with_digits(parameter.quantile(at), 3); };
  constexpr double least = 0.5 / static_cast<double>(bins), most = 1.0 - least;
  body += fmt::format(R"(<rect class="frame" x="{0:.1f}" y="{1:.1f}" width="{2:.1f}" height="{2:.1f}"/>)", left, top,
                      extent);
  body += words_at(left + 0.5 * side, top + extent + 14.0, "middle", end(parameters[x], least)) +
          words_at(left + extent - 0.5 * side, top + extent + 14.0, "middle", end(parameters[x], most)) +
          words_at(left + 0.5 * extent, top + extent + 28.0, "middle", short_path(parameters[x].path)) +
          words_at(left - 6.0, top + extent - 0.5 * side + 4.0, "end", end(parameters[y], least)) +
          words_at(left - 6.0, top + 0.5 * side + 4.0, "end", end(parameters[y], most)) +
          words_at(left - 6.0, top + 0.5 * extent, "end", short_path(parameters[y].path));
  const double legend = left + extent + 40.0;
  for (int i = 0; i <= 4; ++i) {
    const double share = 0.25 * i, y_at = top + 24.0 * static_cast<double>(4 - i);
    body += cell_of(legend, y_at, 20.0, 24.0, share, "");
    body += words_at(legend + 28.0, y_at + 16.0, "", fmt::format("{:.0f} % hunt", 100.0 * share));
  }
  body += words_at(legend, top + 140.0, "", "empty: no loop of the sample");
  return svg_picture(heat_width, top + extent + 40.0,
                     "Share of the loops that hunt over " + parameters[x].path + " and " + parameters[y].path,
                     heat_style, "Share of the loops that hunt, over the two numbers that decide most", body);
}

}  // namespace limcycle
