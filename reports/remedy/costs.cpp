#include "limcycle/reports/remedy/costs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

std::string error_cell(const std::optional<Extent>& error, const Units& units) {
  if (!error) return "-";
  const double low = error->low * units.y_per_si, high = error->high * units.y_per_si;
  const double size = std::max(std::abs(low), std::abs(high));
  if (std::isinf(low) && std::isinf(high)) return "any";
  if (std::abs(low + high) <= 1e-6 * size) return size == 0.0 ? "0" : "+-" + with_digits(size, 3);
  return with_digits(low, 3) + ".." + with_digits(high, 3);
}

std::string cost_cell(const std::optional<double>& value, double factor = 1.0, int digits = 3) {
  return value ? with_digits(*value * factor, digits) : "-";
}

std::vector<std::string> cost_row(const std::string& name, const RemedyCosts& costs, const Units& units) {
  return {name,
          error_cell(costs.steady_state_error, units),
          cost_cell(costs.settling_time),
          cost_cell(costs.overshoot, 100.0),
          cost_cell(costs.phase_margin, 180.0 / std::numbers::pi),
          cost_cell(costs.peak_sensitivity),
          cost_cell(costs.noise_gain),
          cost_cell(costs.actuator_travel),
          cost_cell(costs.robust_share, 100.0)};
}

Json known(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

}  // namespace

Table cost_table(const std::string& heading, const NamedCosts& loops, const Units& units) {
  Table table{{{heading, "", Align::left},
               {"error", units.y},
               {"settles", "s"},
               {"overshoot", "%"},
               {"phase", "deg"},
               {"Ms", ""},
               {"noise", ""},
               {"travel", "N"},
               {"robust", "%"}},
              {}};
  for (const auto& [name, costs] : loops) table.rows.push_back(cost_row(name, *costs, units));
  return table;
}

std::string cost_legend(double step, const Units& units) {
  return fmt::format(
      "error: r - y over all states of rest; settles, overshoot: a step of {} with friction; phase margin and Ms: "
      "without friction; noise: largest gain from y to the command; travel: all that the command goes up and down in "
      "that step; robust: share of [sensitivity] without hunting",
      Units::attach(with_digits(step * units.y_per_si, 3), units.y));
}

std::string costs_json(const RemedyCosts& costs) {
  Json error = nullptr;
  if (costs.steady_state_error) error = {number(costs.steady_state_error->low), number(costs.steady_state_error->high)};
  return json_text({{"steady_state_error", error},
                    {"settling_time", known(costs.settling_time)},
                    {"overshoot", known(costs.overshoot)},
                    {"linear_settling_time", known(costs.linear_settling_time)},
                    {"linear_overshoot", known(costs.linear_overshoot)},
                    {"phase_margin", known(costs.phase_margin)},
                    {"delay_margin", known(costs.delay_margin)},
                    {"peak_sensitivity", known(costs.peak_sensitivity)},
                    {"noise_gain", known(costs.noise_gain)},
                    {"actuator_travel", known(costs.actuator_travel)},
                    {"robust_share", known(costs.robust_share)}});
}

}  // namespace limcycle
