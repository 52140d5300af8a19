#include "limcycle/analysis/study/identify/residuals.hpp"

#include <gsl/gsl_cdf.h>

#include <cstddef>

namespace limcycle {

Whiteness whiteness(std::span<const double> residuals) {
  constexpr std::size_t lags = 10, fewest = 20;
  const std::size_t n = residuals.size();
  Whiteness result;
  double power = 0.0;
  for (const double one : residuals) power += one * one;
  if (n < fewest || !(power > 0.0)) return result;
  double sum = 0.0;
  const auto count = static_cast<double>(n);
  for (std::size_t lag = 1; lag <= lags; ++lag) {
    double product = 0.0;
    for (std::size_t i = lag; i < n; ++i) product += residuals[i] * residuals[i - lag];
    const double correlation = product / power;
    if (lag == 1) result.autocorrelation = correlation;
    sum += correlation * correlation / (count - static_cast<double>(lag));
  }
  result.probability = gsl_cdf_chisq_Q(count * (count + 2.0) * sum, static_cast<double>(lags));
  return result;
}

}  // namespace limcycle
