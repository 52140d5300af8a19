#include "limcycle/reports/figures/harmonics_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/orbit/cycle/spectrum.hpp"
#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

constexpr int shown_harmonics = 15;
constexpr double least_share = 1e-5;

struct HarmonicCurve {
  std::string name, unit;
  std::vector<double> amplitude;  ///< NaN: left out
};

std::optional<std::size_t> cycle_for_harmonics(const PredictReport& report) {
  for (const bool stable : {true, false})
    for (std::size_t i = 0; i < report.cycles.size(); ++i)
      if (report.cycles[i].stable.value_or(false) == stable && report.cycles[i].trace.t.size() > 2) return i;
  return std::nullopt;
}

/// False for a body that keeps turning: its y has no harmonics.
bool comes_back(const std::vector<double>& y) {
  const auto [low, high] = std::minmax_element(y.begin(), y.end());
  return std::abs(y.back() - y.front()) <= 1e-3 * (*high - *low);
}

void add_curve(std::vector<HarmonicCurve>& curves, const std::string& name, const std::string& unit, const Cycle& cycle,
               const std::vector<double>& values) {
  if (values.size() != cycle.trace.t.size()) return;
  auto amplitude = harmonic_amplitudes(cycle.trace.t, values, cycle.period, shown_harmonics);
  const double largest = amplitude.empty() ? 0.0 : *std::ranges::max_element(amplitude);
  if (!(largest > 0.0) || !std::isfinite(largest)) return;
  for (double& one : amplitude)
    if (one < least_share * largest) one = NAN;
  curves.push_back({name, unit, std::move(amplitude)});
}

std::string finding_of(const HarmonicCurve& curve) {
  const auto& a = curve.amplitude;
  std::string out =
      fmt::format("{}: the first harmonic is {}", curve.name, Units::attach(with_digits(a[0], 3), curve.unit));
  std::size_t largest = 1;
  for (std::size_t k = 1; k < a.size(); ++k)
    if (std::isfinite(a[k]) && !(a[k] <= a[largest])) largest = k;
  if (!std::isfinite(a[largest])) return out + ", no other reaches 1e-05 of it";
  return out +
         fmt::format(", the largest other is that of order {}, {} of it", largest + 1, as_percent(a[largest] / a[0]));
}

}  // namespace

std::optional<Figure> harmonics_figure(const PredictReport& report, const Units& units) {
  const auto index = cycle_for_harmonics(report);
  if (!index) return std::nullopt;
  const Cycle& cycle = report.cycles[*index];
  std::vector<HarmonicCurve> curves;
  if (comes_back(cycle.trace.y)) add_curve(curves, "y", units.y, cycle, cycle.trace.y);
  add_curve(curves, units.force.empty() ? "element's output" : "force", units.force, cycle, cycle.trace.output);
  std::erase_if(curves, [](const auto& curve) { return !std::isfinite(curve.amplitude[0]); });
  if (curves.empty()) return std::nullopt;
  Json data{{"order", Json::array()}, {"curves", Json::array()}};
  for (int k = 1; k <= shown_harmonics; ++k) data["order"].push_back(k);
  std::string finding = fmt::format("Limit cycle {}, period {} s. ", *index, with_digits(cycle.period, 4));
  for (const auto& curve : curves) {
    Json amplitude = Json::array();
    for (const double one : curve.amplitude) amplitude.push_back(number(one));
    data["curves"].push_back({{"name", curve.unit.empty() ? curve.name : curve.name + " (" + curve.unit + ")"},
                              {"amplitude", std::move(amplitude)}});
    finding += (&curve == &curves.front() ? "" : "; ") + finding_of(curve);
  }
  return Figure{"harmonics", "Harmonics", finding + ".", figure_data(json_text(data))};
}

}  // namespace limcycle
