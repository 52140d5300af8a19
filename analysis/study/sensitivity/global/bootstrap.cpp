#include "limcycle/analysis/study/sensitivity/global/bootstrap.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>

namespace limcycle {
namespace {

constexpr std::size_t fewest_units = 8, fewest_resamples = 100;

/// Number of times each unit was drawn, in `units` draws with replacement.
void draw(RandomStream& random, std::vector<double>& weights) {
  std::ranges::fill(weights, 0.0);
  for (std::size_t k = 0; k < weights.size(); ++k) weights[random.below(weights.size())] += 1.0;
}

/// Share of the resamples that is cut off at either end.
double tail(std::size_t units) {
  const auto u = static_cast<double>(units);
  return gsl_cdf_ugaussian_Q(std::sqrt(u / (u - 1.0)) * gsl_cdf_tdist_Qinv(0.025, u - 1.0));
}

}  // namespace

std::vector<Estimate> bootstrap(std::size_t units, std::size_t resamples, RandomStream random,
                                const Statistics& statistics) {
  std::vector<double> weights(units, 1.0);
  const auto values = statistics(weights);
  std::vector<Estimate> estimates(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i]) estimates[i].value = *values[i], estimates[i].known = true;
  if (units < fewest_units || resamples < fewest_resamples) return estimates;

  std::vector<std::vector<double>> drawn(values.size());
  for (std::size_t r = 0; r < resamples; ++r) {
    draw(random, weights);
    const auto again = statistics(weights);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (again[i]) drawn[i].push_back(*again[i]);
  }
  const double cut = tail(units);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!estimates[i].known || 40 * drawn[i].size() < 39 * resamples) continue;
    std::ranges::sort(drawn[i]);
    estimates[i].low = percentile(drawn[i], cut);
    estimates[i].high = percentile(drawn[i], 1.0 - cut);
  }
  return estimates;
}

}  // namespace limcycle
