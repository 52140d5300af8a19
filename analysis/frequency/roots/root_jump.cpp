#include "limcycle/analysis/frequency/roots/root_jump.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace limcycle {

std::optional<RootJump> jump_in(const CellSamples& values) {
  constexpr double apart = 4.0;
  std::size_t one = 0, other = 0;  // the two samples that are farthest from each other stand for the sides
  for (std::size_t a = 0; a < values.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (std::abs(values[a] - values[b]) > std::abs(values[one] - values[other])) {
        one = a;
        other = b;
      }
  const auto beyond = [&](std::size_t k) {
    return std::abs(values[k] - values[other]) < std::abs(values[k] - values[one]);
  };
  RootJump jump{std::numeric_limits<double>::infinity(), 0.0, std::abs(nearest_in_hull(values))};
  for (std::size_t a = 0; a < values.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const double between = std::abs(values[a] - values[b]);
      if (beyond(a) == beyond(b))
        jump.spread = std::max(jump.spread, between);
      else
        jump.height = std::min(jump.height, between);
    }
  return one != other && jump.height > apart * jump.spread ? std::optional(jump) : std::nullopt;
}

}  // namespace limcycle
