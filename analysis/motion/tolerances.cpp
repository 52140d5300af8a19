#include "limcycle/analysis/motion/tolerances.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;

/// Factor on the velocity scale of a set-valued law whose curve begins with infinite slope, g = Fs - (...)|v/vs|^delta
/// with delta < 1: the force is right to rtol only where v is right to vs rtol^(1/delta), and implicit stages must not
/// cross the steep part unseen.
double steepness(const Element<double>& element, double rtol) {
  return std::visit(
      [&]<class E>(const E& e) {
        if constexpr (CanHold<E> && requires { e.curve.index, e.delta, e.vs; }) {
          constexpr std::size_t tustin = 1;  // which is delta = 1, whatever delta is
          if (e.curve.index != tustin && e.delta < 1.0) return 1e-3 * std::pow(rtol, 1.0 / e.delta - 1.0);
        }
        return 1.0;
      },
      element);
}

}  // namespace

std::vector<double> pole_moduli(const Loop& loop) {
  std::vector<double> found;
  if (loop.states() == 0) return found;
  const Eigen::VectorXd moduli = eigenvalues(loop.tangent()).cwiseAbs();
  for (const double modulus : moduli)
    if (modulus > 1e-9 * moduli.maxCoeff()) found.push_back(modulus);
  std::ranges::sort(found);
  return found;
}

State typical_sizes(const Loop& loop) {
  const Index n = loop.states();
  std::vector<double> frequencies = pole_moduli(loop);  // at which the linear part has something to say
  if (frequencies.empty()) frequencies.push_back(1.0);
  Eigen::VectorXd size = Eigen::VectorXd::Zero(n);
  for (const double w : frequencies) {
    Eigen::MatrixXcd M =
        std::complex<double>(0.0, w) * Eigen::MatrixXcd::Identity(n, n) - loop.A.cast<std::complex<double>>();
    const Eigen::MatrixXcd response = M.fullPivLu().solve(loop.B.cast<std::complex<double>>());
    for (Index i = 0; i < n; ++i)
      for (Index k = 0; k < response.cols(); ++k) {
        const double level = std::abs(response(i, k)) * scales_of(loop.elements[static_cast<std::size_t>(k)]).output;
        if (std::isfinite(level)) size(i) = std::max(size(i), level);
      }
  }
  const double largest = size.maxCoeff();
  State result;
  for (Index i = 0; i < n; ++i)
    result.push_back(size(i) > 1e-9 * largest ? size(i) : largest > 0.0 ? 1e-9 * largest : 1.0);
  for (const auto& element : loop.elements)
    std::visit(
        [&](const auto& e) {
          for (int k = 0; k < e.states(); ++k) result.push_back(e.state_scale(k));
        },
        element);
  return result;
}

ErrorWeights loop_weights(const Loop& loop, double rtol) { return loop_weights(loop, rtol, typical_sizes(loop)); }

ErrorWeights loop_weights(const Loop& loop, double rtol, State typical) {
  if (!(rtol > 0.0 && rtol <= 0.1))
    throw std::invalid_argument("rtol must be in (0, 0.1], got " + std::to_string(rtol));
  ErrorWeights weights{rtol, std::move(typical)};
  const auto n = static_cast<std::size_t>(loop.states());
  for (std::size_t i = 0; i < n; ++i) weights.atol[i] *= 1e-3;
  for (std::size_t k = 0; k < loop.elements.size(); ++k) {
    const Scales scales = scales_of(loop.elements[k]);
    const auto limit = [&](const Eigen::RowVectorXd& row, double scale) {
      if (!std::isfinite(scale)) return;
      for (std::size_t i = 0; i < n; ++i)
        if (const double part = std::abs(row(static_cast<Index>(i))); part > 0.0)
          weights.atol[i] = std::min(weights.atol[i], scale / part);
    };
    if (!loop.ports[k].rubs) continue;
    limit(loop.ports[k].C, scales.displacement);
    limit(loop.ports[k].C_v, scales.velocity * steepness(loop.elements[k], rtol));
    // The rubbing velocity of a belt is a difference from its speed: no tolerance may ask for less than its rounding.
    const double speed = std::abs(loop.ports[k].c_v.dot(loop.external));
    for (std::size_t i = 0; i < n; ++i)
      if (const double part = std::abs(loop.ports[k].C_v(static_cast<Index>(i))); part > 0.0)
        weights.atol[i] = std::max(weights.atol[i], 1e-6 * speed / part);
  }
  for (auto& value : weights.atol) value *= rtol;
  return weights;
}

}  // namespace limcycle
