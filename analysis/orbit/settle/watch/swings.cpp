#include "limcycle/analysis/orbit/settle/watch/swings.hpp"

namespace limcycle {

void Swings::try_later() {
  const std::size_t turns = turning.points().size();
  next_try = turns + (turns - leapt_at) / 2 + 1;
}

double largest_change(const TurningPoints& turning, std::size_t order) {
  double largest = 0.0;
  for (std::size_t k = 0; k < order; ++k)
    largest = std::max(largest, std::abs(turning.swing(k) / turning.swing(k + order) - 1.0));
  return largest;
}

bool shrinks_to_nothing(const TurningPoints& turning, std::size_t order) {
  constexpr double small = 0.3;
  if (turning.points().size() <= 2 * order + 1) return false;
  const double now = turning.swing(0), before = turning.swing(order), first = turning.swing(2 * order);
  const double last_change = before - now, change = first - before;
  if (!(last_change > 0.0) || !(change >= last_change)) return false;
  return change == last_change || now - last_change * last_change / (change - last_change) < small * now;
}

}  // namespace limcycle
