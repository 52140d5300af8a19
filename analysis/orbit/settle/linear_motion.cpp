#include "limcycle/analysis/orbit/settle/linear_motion.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "limcycle/models/linear/dense.hpp"
#include "limcycle/models/linear/transfer.hpp"
#include "limcycle/models/parameter.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

/// Orthonormal directions along which no held row changes.
MatrixXd free_of(const MatrixXd& held, Index n) {
  if (held.rows() == 0) return MatrixXd::Identity(n, n);
  const PivotedQr qr = pivoted_qr(held.transpose());
  return qr.Q.rightCols(n - qr.rank);
}

/// Sorts the modes into those that decay and neutral ones; false if one grows or winds up.
bool settle_modes(LinearMotion& motion, const VectorXcd& parts, int neutral) {
  constexpr double rounding = 1e-12;
  std::vector<Index> order(static_cast<std::size_t>(parts.size()));
  for (Index k = 0; k < parts.size(); ++k) order[static_cast<std::size_t>(k)] = k;
  std::ranges::sort(order, {}, [&](Index k) { return std::abs(motion.eigenvalues(k)); });
  const double largest = motion.eigenvalues.cwiseAbs().maxCoeff();
  motion.decay = infinite;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Index k = order[i];
    if (i < static_cast<std::size_t>(neutral)) {
      motion.neutral[static_cast<std::size_t>(k)] = true;
      if (std::abs(parts(k)) > rounding) return false;
      continue;
    }
    const double real = motion.eigenvalues(k).real();
    if (real > -rounding * largest) return false;
    motion.amounts(k) = parts(k) / motion.eigenvalues(k);
    motion.decay = std::min(motion.decay, -real);
  }
  return std::isfinite(motion.decay);
}

}  // namespace

State LinearMotion::around(const State& centre, const VectorXcd& of_modes) const {
  const VectorXd away = (directions * of_modes).real().cwiseProduct(sizes);
  State x = centre;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += away(static_cast<Index>(i));
  return x;
}

LinearMotion linear_motion(const MatrixXd& J, const VectorXd& rates, const MatrixXd& held, const VectorXd& sizes) {
  LinearMotion motion{sizes, J, {}, {}, {}, {}, {}, 0.0, false};
  if (!J.allFinite() || !rates.allFinite()) return motion;
  const MatrixXd Q = free_of(held, J.rows());
  const MatrixXd reduced = Q.transpose() * J * Q;
  if (reduced.size() == 0) {  // everything is held
    motion.directions = MatrixXcd::Zero(J.rows(), 0);
    motion.inverse = MatrixXcd::Zero(0, J.rows());
    motion.decay = infinite;
    motion.settles = rates.cwiseAbs().maxCoeff() <= 1e-9;
    return motion;
  }
  const ZeroModes zero = zero_modes(reduced);
  if (zero.times != zero.directions) return motion;
  const auto [values, V] = eigen_pairs(reduced);
  const auto inverse = solve_if_regular(V, Q.transpose().cast<std::complex<double>>(), 1e-10);
  if (!inverse) return motion;
  motion.eigenvalues = values;
  motion.directions = Q.cast<std::complex<double>>() * V;
  motion.inverse = *inverse;
  motion.amounts = VectorXcd::Zero(V.cols());
  motion.neutral.assign(static_cast<std::size_t>(V.cols()), false);
  motion.settles = settle_modes(motion, motion.inverse * rates.cast<std::complex<double>>(), zero.times);
  return motion;
}

bool stay_positive(const std::function<void(const State& x, std::vector<double>& values)>& functions,
                   const State& centre, const LinearMotion& motion) {
  std::vector<double> at_centre, moved;
  functions(centre, at_centre);
  std::vector<double> reach(at_centre.size(), 0.0);
  const Index n = motion.amounts.size();
  for (Index k = 0; k < n; ++k) {
    if (motion.amounts(k) == 0.0) continue;
    std::vector<double> square(at_centre.size(), 0.0);
    for (const std::complex<double> turn : {std::complex<double>(1.0, 0.0), std::complex<double>(0.0, 1.0)}) {
      functions(motion.around(centre, VectorXcd::Unit(n, k) * (std::abs(motion.amounts(k)) * turn)), moved);
      for (std::size_t i = 0; i < moved.size(); ++i) square[i] += (moved[i] - at_centre[i]) * (moved[i] - at_centre[i]);
    }
    for (std::size_t i = 0; i < square.size(); ++i) reach[i] += std::sqrt(square[i]);
  }
  for (std::size_t i = 0; i < reach.size(); ++i)
    if (!(at_centre[i] > reach[i])) return false;
  return true;
}

}  // namespace limcycle
