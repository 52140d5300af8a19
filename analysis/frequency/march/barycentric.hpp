#pragma once
#include <algorithm>
#include <cstddef>
#include <span>

namespace limcycle {

/// Shares of the values at `nodes` in the interpolating polynomial at a place, from barycentric weights: exact at a
/// node. All spans have one length. Berrut and Trefethen, Barycentric Lagrange Interpolation (2004), eq. 4.2.
inline void barycentric_shares(std::span<const double> nodes, std::span<const double> weights, double at,
                               std::span<double> shares) {
  double sum = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double distance = at - nodes[i];
    if (distance == 0.0) {
      std::ranges::fill(shares, 0.0);
      shares[i] = 1.0;
      return;
    }
    sum += shares[i] = weights[i] / distance;
  }
  for (double& share : shares) share /= sum;
}

}  // namespace limcycle
