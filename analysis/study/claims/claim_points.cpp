#include "limcycle/analysis/study/claims/claim_points.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"

namespace limcycle {

double RandomPoints::log_between(double low, double high) { return low * std::exp(share() * std::log(high / low)); }

std::string place(std::initializer_list<Named> numbers) {
  std::string text;
  for (const Named& one : numbers) {
    text += (text.empty() ? "" : ", ") + std::string(one.name) + " = " + short_number(one.value, 6);
    if (!one.unit.empty()) text += " " + std::string(one.unit);
  }
  return text;
}

void check_printed(ClaimChecks& checks, std::string where, std::string quantity, std::string unit, double printed,
                   double last_digit, double computed, double error) {
  const double size = std::max(std::abs(printed), last_digit);
  checks.equal(std::move(where), std::move(quantity) + " as printed", std::move(unit), printed, computed,
               (0.6 * last_digit + error) / size, size);
}

}  // namespace limcycle
