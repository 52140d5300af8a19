#include "limcycle/analysis/study/remedy/remedy_order.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace limcycle {
namespace {

using ComparedCosts = std::array<std::optional<double>, std::size(cost_names)>;

/// The costs as numbers of which less is better; empty: not known.
ComparedCosts compared(const RemedyCosts& costs) {
  const auto minus = [](const std::optional<double>& x) { return x ? std::optional(-*x) : std::nullopt; };
  std::optional<double> error;
  if (costs.steady_state_error)
    error = std::max(std::abs(costs.steady_state_error->low), std::abs(costs.steady_state_error->high));
  return {error,
          costs.settling_time,
          costs.overshoot,
          minus(costs.phase_margin),
          minus(costs.delay_margin),
          costs.peak_sensitivity,
          costs.noise_gain,
          costs.actuator_travel,
          minus(costs.robust_share)};
}

/// True if `a` is at least as good as `b` in every cost, an unknown one being the worst, and better in one.
bool dominates(const RemedyCosts& a, const RemedyCosts& b) {
  const auto of_a = compared(a), of_b = compared(b);
  bool better = false;
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    if (of_b[i] && (!of_a[i] || *of_a[i] > *of_b[i])) return false;
    better = better || (of_a[i] && (!of_b[i] || *of_a[i] < *of_b[i]));
  }
  return better;
}

int place_of(const Remedy& remedy) {
  if (remedy.best) return 0;
  if (remedy.ends == true) return 1;
  if (!remedy.candidate.why_not.empty()) return 4;
  return remedy.ends ? 3 : 2;
}

void order_by_weight(std::span<Remedy> ending, const CostWeights& weights) {
  std::vector<ComparedCosts> costs;
  for (const Remedy& one : ending) costs.push_back(compared(one.costs));
  const auto score = [&](const Remedy& one) {
    const auto own = compared(one.costs);
    double sum = 0.0;
    for (std::size_t i = 0; i < own.size(); ++i) {
      double low = infinite, high = -infinite;
      for (const auto& other : costs) {
        if (!other[i]) continue;
        low = std::min(low, *other[i]);
        high = std::max(high, *other[i]);
      }
      if (!(low <= high)) continue;  // known of none
      const double share = !own[i] ? 1.0 : high > low ? (*own[i] - low) / (high - low) : 0.0;
      sum += weights[i] * (std::isnan(share) ? 1.0 : share);
    }
    return sum;
  };
  std::ranges::stable_sort(ending, {}, score);
}

}  // namespace

void order_remedies(std::vector<Remedy>& remedies, const CostWeights& weights) {
  for (Remedy& remedy : remedies)
    remedy.best = remedy.ends == true && std::ranges::none_of(remedies, [&](const Remedy& other) {
                    return other.ends == true && dominates(other.costs, remedy.costs);
                  });
  std::ranges::stable_sort(remedies, {}, place_of);
  if (std::ranges::none_of(weights, [](double weight) { return weight > 0.0; })) return;
  const auto count = std::ranges::count_if(remedies, [](const Remedy& one) { return one.ends == true; });
  order_by_weight(std::span(remedies.begin(), remedies.begin() + count), weights);
}

}  // namespace limcycle
