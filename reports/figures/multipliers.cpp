#include "limcycle/reports/figures/multipliers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "limcycle/reports/format/json_values.hpp"
#include "limcycle/reports/format/number.hpp"

namespace limcycle {
namespace {

constexpr std::size_t widest = 48;  // columns of the multipliers shown
constexpr double negligible = 1e-6;

/// As many digits as are right, at most three.
std::string right_digits(double value, double error) {
  const double right = error > 0.0 && std::isfinite(value) ? std::floor(std::log10(std::abs(value) / error)) : 3.0;
  return with_digits(value, static_cast<int>(std::clamp(right, 1.0, 3.0)));
}

std::string in_words(std::complex<double> value, bool pair, double error) {
  std::string real = right_digits(value.real(), error);
  if (value.imag() == 0.0) return real;
  const std::string imaginary = right_digits(std::abs(value.imag()), error) + "j";
  return real + (pair ? " ± " : value.imag() < 0.0 ? " - " : " + ") + imaginary;
}

}  // namespace

std::string multipliers_in_words(const std::vector<std::complex<double>>& multipliers, double error) {
  std::string out;
  std::size_t i = 0;
  while (i < multipliers.size()) {
    const auto value = multipliers[i];
    if (std::abs(value) < negligible) break;
    const bool pair = value.imag() != 0.0 && i + 1 < multipliers.size() &&
                      std::abs(multipliers[i + 1] - std::conj(value)) <= 1e-9 * std::abs(value);
    const std::string own = (out.empty() ? "" : ", ") + in_words(value, pair, error);
    if (!out.empty() && display_width(out) + display_width(own) > widest) break;
    out += own;
    i += pair ? 2 : 1;
  }
  if (i == multipliers.size()) return out;
  const std::size_t left = multipliers.size() - i;
  const bool small = std::abs(multipliers[i]) < negligible;
  return out + (out.empty() ? "" : ", ") + fmt::format("{} {}", left, small ? "below 1e-06" : "smaller");
}

Table multiplier_table(const PredictReport& report) {
  Table table{{{"#", "", Align::left}, {"over", "s"}, {"largest first", "", Align::left}}, {}};
  for (std::size_t i = 0; i < report.cycles.size(); ++i) {
    const Cycle& cycle = report.cycles[i];
    const bool unknown = cycle.multipliers.empty() && cycle.multiplier_error > 0.5;
    if (unknown || !cycle.multipliers.empty())
      table.rows.push_back(
          {std::to_string(i), with_digits(cycle.period, 4),
           unknown ? "could not be determined" : multipliers_in_words(cycle.multipliers, cycle.multiplier_error)});
  }
  return table;
}

std::optional<Figure> multiplier_figure(const PredictReport& report) {
  Json cycles = Json::array();
  std::string words;
  for (std::size_t i = 0; i < report.cycles.size(); ++i) {
    const Cycle& cycle = report.cycles[i];
    if (cycle.multipliers.empty()) continue;
    Json re = Json::array(), im = Json::array();
    for (const auto& value : cycle.multipliers) {
      re.push_back(value.real());  // non-finite values become null
      im.push_back(value.imag());
    }
    cycles.push_back({{"name", fmt::format("limit cycle {}", i)}, {"re", re}, {"im", im}});
    words += fmt::format("{} {} of limit cycle {}", words.empty() ? "" : ",",
                         right_digits(std::abs(cycle.multipliers.front()), cycle.multiplier_error), i);
  }
  if (cycles.empty()) return std::nullopt;
  return Figure{"multipliers", "Floquet multipliers and the unit circle",
                "Neighbouring motions return to a limit cycle if all its multipliers lie inside the circle. Modulus of "
                "the largest:" +
                    words + ".",
                json_text({{"cycles", cycles}})};
}

}  // namespace limcycle
