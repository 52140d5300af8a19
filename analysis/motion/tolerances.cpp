#include "limcycle/analysis/motion/tolerances.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"

namespace limcycle {
namespace {

using Eigen::Index;

/// Factor on the velocity scale of a law whose steep_exponent() is below 1: for a force accurate to rtol, v must be
/// accurate to vs rtol^(1/delta), and implicit stages must not skip the steep part. A body that breaks away gains the
/// velocity of a tighter tolerance within the rounding of time: no step would pass.
double steepness(const Element& element, double rtol) {
  constexpr double tightest = 1e-7;
  const double delta = element.steep_exponent();
  return delta < 1.0 ? 1e-3 * std::pow(std::max(rtol, tightest), 1.0 / delta - 1.0) : 1.0;
}

/// On a belt a body is at rest at the belt's speed. Where the curve is infinitely steep there, the velocity is as small
/// as it differs from that: relative to itself, an error would be as large as a whole start of slip.
void count_from_rest(const Port& port, const External& external, ErrorWeights& weights) {
  const double speed = port.c_v.dot(external);
  std::optional<std::size_t> only;
  for (Index i = 0; i < port.C_v.size(); ++i) {
    if (port.C_v(i) == 0.0) continue;
    if (only) return;
    only = static_cast<std::size_t>(i);
  }
  if (!only || speed == 0.0) return;
  weights.origin.resize(weights.atol.size(), 0.0);
  weights.origin[*only] = -speed / port.C_v(static_cast<Index>(*only));
}

}  // namespace

bool has_infinite_slope(const Loop& loop) {
  return std::ranges::any_of(loop.elements, [](const Element& element) { return element.steep_exponent() < 1.0; });
}

ErrorWeights loop_weights(const Loop& loop, double rtol) { return loop_weights(loop, rtol, typical_sizes(loop)); }

ErrorWeights loop_weights(const Loop& loop, double rtol, State typical, bool stuck) {
  if (!(rtol > 0.0 && rtol <= 0.1))
    throw std::invalid_argument("rtol must be in (0, 0.1], got " + std::to_string(rtol));
  ErrorWeights weights{rtol, std::move(typical), {}, std::exp2(std::round(std::log2(slow_time(loop))))};
  const auto n = static_cast<std::size_t>(loop.states());
  for (std::size_t i = 0; i < n; ++i) weights.atol[i] *= 1e-3;
  for (std::size_t k = 0; k < loop.elements.size(); ++k) {
    const Scales scales = loop.elements[k].scales();
    const auto limit = [&](const Eigen::RowVectorXd& row, double scale) {
      if (!std::isfinite(scale)) return;
      for (std::size_t i = 0; i < n; ++i)
        if (const double part = std::abs(row(static_cast<Index>(i))); part > 0.0)
          weights.atol[i] = std::min(weights.atol[i], scale / part);
    };
    if (!loop.ports[k].rubs) continue;
    limit(loop.ports[k].C, scales.displacement);
    limit(loop.ports[k].C_v, scales.velocity * (stuck ? 1.0 : steepness(loop.elements[k], rtol)));
    if (loop.elements[k].steep_exponent() < 1.0) count_from_rest(loop.ports[k], loop.external, weights);
    // The rubbing velocity of a belt is a difference from its speed: no tolerance may ask for less than its rounding.
    const double speed = std::abs(loop.ports[k].c_v.dot(loop.external));
    for (std::size_t i = 0; i < n; ++i)
      if (const double part = std::abs(loop.ports[k].C_v(static_cast<Index>(i))); part > 0.0)
        weights.atol[i] = std::max(weights.atol[i], 1e-6 * speed / part);
  }
  // A loop whose numbers over- or underflow is still marched, as far as possible.
  constexpr double least = std::numeric_limits<double>::min(), most = std::numeric_limits<double>::max();
  for (auto& value : weights.atol) value = std::isnan(value) ? rtol : std::clamp(value * rtol, least, most);
  return weights;
}

}  // namespace limcycle
