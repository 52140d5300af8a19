#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "limcycle/analysis/frequency/describing_function/df_undefined.hpp"
#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/text.hpp"

namespace limcycle {
namespace {

constexpr double finest = 0.6e-6;  // seven digits: more would not fit 80 columns; JSON and CSV have all

std::string limited(double value, double error) {
  if (std::abs(value) <= error) return "0";
  return with_error(value, std::max(error / std::abs(value), finest));
}

Table df_table(const std::vector<DfPoint>& points, const std::vector<DescribingFunction>& results) {
  const bool biased =
      std::any_of(points.begin(), points.end(), [](const auto& point) { return point.bias != 0.0; }) ||
      std::any_of(results.begin(), results.end(), [](const auto& result) { return result.mean != 0.0; });
  Table table;
  table.columns = {{"amplitude", ""}, {"frequency", "rad/s"}};
  if (biased) table.columns.push_back({"bias", ""});
  table.columns.insert(table.columns.end(), {{"Re N", ""}, {"Im N", ""}});
  if (biased) table.columns.push_back({"mean", ""});
  table.columns.insert(table.columns.end(), {{"work", "J"}, {"error", ""}});
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto& result = results[i];
    const bool known = result.answered();
    // The error is relative to |N|: the parts of N, and the work pi A^2 Im N, have it as an absolute error.
    const double error = result.error * std::abs(result.gain);
    const double area = std::numbers::pi * points[i].amplitude * points[i].amplitude;
    std::vector<std::string> row = {fmt::format("{:.6g}", points[i].amplitude),
                                    fmt::format("{:.6g}", points[i].frequency)};
    if (biased) row.push_back(fmt::format("{:.6g}", points[i].bias));
    row.push_back(known ? limited(result.gain.real(), error) : "-");
    row.push_back(known ? limited(result.gain.imag(), error) : "-");
    if (biased) row.push_back(known ? with_digits(result.mean, 6) : "-");
    row.push_back(known ? limited(result.dissipation, error * area) : "-");
    row.push_back(known ? as_error(result.error) : "-");
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string summary(const std::vector<DfPoint>& points, const std::vector<DescribingFunction>& results) {
  const auto range = [&](const char* name, double DfPoint::*member) {
    double low = points[0].*member, high = low;
    for (std::size_t i = 0; i < results.size(); ++i) {
      low = std::min(low, points[i].*member);
      high = std::max(high, points[i].*member);
    }
    return fmt::format("{} {} to {}", name, with_digits(low, 4), with_digits(high, 4));
  };
  double least = INFINITY, most = 0.0;
  for (const auto& result : results) {
    if (!result.answered()) continue;
    least = std::min(least, std::abs(result.gain));
    most = std::max(most, std::abs(result.gain));
  }
  std::string out = wrapped(fmt::format("{}, {}, {}.", range("amplitude", &DfPoint::amplitude),
                                        range("frequency", &DfPoint::frequency), range("bias", &DfPoint::bias)));
  if (most > 0.0) out += fmt::format("|N| from {} to {}.\n", with_digits(least, 5), with_digits(most, 5));
  return out + fmt::format("A table of more than {} points is not printed: --csv FILE or --csv - writes it.\n",
                           longest_table);
}

}  // namespace

Document df_document(const std::string& title, const std::vector<DfPoint>& points,
                     const std::vector<DescribingFunction>& results) {
  if (results.size() > points.size()) throw std::invalid_argument("more describing functions than points");
  Document out(wrapped(title) + "\n");
  if (results.empty())
    out += "No point was computed.\n";
  else if (results.size() > longest_table)
    out += summary(points, results);
  else
    out.add_untitled("Describing function", df_table(points, results));
  std::map<std::string_view, std::size_t> methods, problems;
  double worst = -1.0;
  for (const auto& result : results) {
    if (result.status == Status::converged) ++methods[result.method];
    if (result.status != Status::converged) ++problems[to_string(result.status)];
    if (result.answered()) worst = std::max(worst, result.error);
  }
  std::string found = fmt::format("{} of {} points", results.size(), points.size());
  if (worst >= 0.0) found += fmt::format("; worst estimated relative error of N {}", as_error(worst));
  for (const auto& [method, n] : methods) found += fmt::format("; {} by {}", n, method);
  out += "\n" + wrapped(found + ".");
  for (const auto& [status, n] : problems)
    out += fmt::format("{} {}: {}.\n", n, n == 1 ? "point" : "points",
                       status == "incomplete"  ? "the wanted accuracy was not reached (see the error)"
                       : status == "undefined" ? undefined_text
                                               : status);
  return out;
}

std::string df_text(const std::string& title, const std::vector<DfPoint>& points,
                    const std::vector<DescribingFunction>& results) {
  return df_document(title, points, results).text();
}

}  // namespace limcycle
