#include "limcycle/analysis/study/sensitivity/global/share_of.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace limcycle {
namespace {
constexpr double normal_975 = 1.959963984540054;  // 97.5 % of a normal distribution lie below
}

Estimate share_of(std::size_t yes, std::size_t samples) {
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
          .among_decided = share_of(yes, yes + no),
          .low = share_of(yes, all).low,
          .high = share_of(yes + undecided, all).high};
}

Probability probability(const SobolDesign& design, RowAnswers answers) {
  if (answers.size() != design.rows())
    throw std::invalid_argument("a probability over a design needs an answer, or none, for each of its " +
                                std::to_string(design.rows()) + " rows, got " + std::to_string(answers.size()));
  std::size_t yes = 0, no = 0, undecided = 0;
  for (std::size_t k = 0; k < design.samples(); ++k)
    for (const auto row : {design.row_a(k), design.row_b(k)}) {
      const auto& answer = answers[row];
      ++(!answer || !std::isfinite(*answer) ? undecided : *answer > 0.5 ? yes : no);
    }
  return probability(yes, no, undecided);
}

}  // namespace limcycle
