#include "limcycle/analysis/study/sensitivity/global/probability_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace limcycle {
namespace {
constexpr double normal_975 = 1.959963984540054;  // 97.5 % of a normal distribution lie below
}

Estimate probability_estimate(std::size_t yes, std::size_t samples) {
  if (yes > samples)
    throw std::invalid_argument(std::to_string(yes) + " of " + std::to_string(samples) + " is not a share");
  if (samples == 0) return {.value = 0.0, .low = 0.0, .high = 1.0, .known = false};
  const double n = static_cast<double>(samples), share = static_cast<double>(yes) / n;
  const double z2 = normal_975 * normal_975, middle = (share + 0.5 * z2 / n) / (1.0 + z2 / n);
  const double half = normal_975 / (1.0 + z2 / n) * std::sqrt(share * (1.0 - share) / n + 0.25 * z2 / (n * n));
  // Rounding must not move an end beyond the share itself.
  return {.value = share,
          .low = yes == 0 ? 0.0 : std::clamp(middle - half, 0.0, share),
          .high = yes == samples ? 1.0 : std::clamp(middle + half, share, 1.0),
          .known = true};
}

Probability probability(std::size_t yes, std::size_t no, std::size_t undecided) {
  const std::size_t all = yes + no + undecided;
  return {.yes = yes,
          .no = no,
          .undecided = undecided,
          .among_decided = probability_estimate(yes, yes + no),
          .low = probability_estimate(yes, all).low,
          .high = probability_estimate(yes + undecided, all).high};
}

}  // namespace limcycle
