#include "limcycle/analysis/motion/error_weights.hpp"

#include <stdexcept>
#include <string>

namespace limcycle {

void ErrorWeights::require_valid() const {
  if (!(rtol >= 0 && std::isfinite(rtol)))
    throw std::invalid_argument("relative tolerance must be finite and at least 0, got " + std::to_string(rtol));
  if (atol.empty()) throw std::invalid_argument("absolute tolerances: need one for each component, got 0 of them");
  for (std::size_t i = 0; i < atol.size(); ++i)
    if (!(atol[i] > 0 && std::isfinite(atol[i])))
      throw std::invalid_argument("absolute tolerance of component " + std::to_string(i) +
                                  " must be finite and more than 0, got " + std::to_string(atol[i]));
}

void ErrorWeights::require_size(std::size_t n) const {
  if (atol.size() != n)
    throw std::invalid_argument("absolute tolerances: need one for each of " + std::to_string(n) + " components, got " +
                                std::to_string(atol.size()));
}

double ErrorWeights::norm(const State& x_old, const State& x_new, const State& error) const {
  double worst = 0;
  for (std::size_t i = 0; i < atol.size(); ++i) {
    const double reach = std::max(size(i, x_old[i]), size(i, x_new[i]));
    const double ratio = std::abs(error[i]) / (atol[i] + rtol * reach);
    // std::max(a, NaN) would drop a NaN, so each component is checked.
    if (!std::isfinite(ratio) || !std::isfinite(x_new[i])) return std::numeric_limits<double>::infinity();
    worst = std::max(worst, ratio);
  }
  return worst;
}

}  // namespace limcycle
