#include "limcycle/analysis/orbit/floquet.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Square matrices whose size is known when compiling: the factors are many and small.
template <int N>
using Square = Eigen::Matrix<double, N, N>;

/// One pass of orthogonal iteration: Q goes in as Q_0 and comes out as Q_K; the triangles are kept. `rounding`: what is
/// smaller than this share of what it was made from is zero.
template <int N>
void pass(const std::vector<MatrixXd>& factors, Square<N>& Q, std::vector<Square<N>>& triangles, double rounding) {
  const Index m = Q.cols();
  triangles.clear();
  for (const MatrixXd& factor : factors) {
    const Eigen::Map<const Eigen::Matrix<double, N, N>> F(factor.data(), factor.rows(), factor.cols());
    const Square<N> moved = F * Q;
    const Eigen::HouseholderQR<Square<N>> qr(moved);
    Square<N> R = Square<N>::Zero(m, m);
    R.template triangularView<Eigen::Upper>() = qr.matrixQR().topRows(m);
    const double least = rounding * (F.cwiseAbs() * Q.cwiseAbs()).maxCoeff();
    for (Index i = 0; i < m; ++i)
      if (std::abs(R(i, i)) <= least) R(i, i) = 0.0;
    Q = qr.householderQ() * Square<N>::Identity(moved.rows(), m);
    triangles.push_back(std::move(R));
  }
}

/// Eigenvalues of Z_b R_K,b ... R_1,b for the diagonal block of indices first..last.
template <int N>
void block_values(const MatrixXd& Z, const std::vector<Square<N>>& triangles, Index first, Index last,
                  std::vector<std::complex<double>>& values) {
  const Index size = last - first + 1;
  MatrixXd product = MatrixXd::Identity(size, size);
  double log_scale = 0.0;
  for (const Square<N>& R : triangles) {
    product = (R.block(first, first, size, size) * product).eval();
    const double norm = product.cwiseAbs().maxCoeff();
    if (norm == 0.0) {
      values.insert(values.end(), static_cast<std::size_t>(size), {0.0, 0.0});
      return;
    }
    product /= norm;
    log_scale += std::log(norm);
  }
  const MatrixXd closed = Z.block(first, first, size, size) * product;
  for (const auto& value : closed.eigenvalues()) values.push_back(value * std::exp(log_scale));
}

/// Two factors instead of many: the triangles of one pass multiplied together (each diagonal entry of which is a
/// product of numbers, and as right as they are), and the orthogonal matrix that is left.
template <int N>
std::vector<MatrixXd> condensed(const std::vector<MatrixXd>& factors) {
  const Index m = factors.front().cols();
  Square<N> Q = Square<N>::Identity(m, m), T = Q;
  std::vector<Square<N>> triangles;
  pass<N>(factors, Q, triangles, 1e-13);  // what a switch annihilates is left as rounding
  for (const Square<N>& R : triangles) T = (R * T).eval();
  return {MatrixXd(T), MatrixXd(Q)};
}

template <int N>
std::vector<std::complex<double>> eigenvalues(const std::vector<MatrixXd>& all) {
  std::vector<std::complex<double>> values;
  const Index m = all.front().cols();
  const std::vector<MatrixXd> factors = condensed<N>(all);
  Square<N> Q = Square<N>::Identity(m, m);
  MatrixXd Z;
  std::vector<Square<N>> triangles;
  for (int sweep = 0; sweep < 30; ++sweep) {
    const Square<N> before = Q;
    pass<N>(factors, Q, triangles, 0.0);
    Z = before.transpose() * Q;
    if (sweep > 1 && Z.triangularView<Eigen::StrictlyLower>().toDenseMatrix().cwiseAbs().maxCoeff() < 1e-14) break;
  }
  for (Index first = 0; first < m;) {
    Index last = first;  // the block reaches as far as anything below the diagonal couples
    for (Index column = first; column <= last; ++column)
      for (Index row = m - 1; row > last; --row)
        if (std::abs(Z(row, column)) > 1e-10) last = row;
    block_values<N>(Z, triangles, first, last, values);
    first = last + 1;
  }
  std::ranges::sort(values, [](auto a, auto b) {
    return std::abs(a) != std::abs(b) ? std::abs(a) > std::abs(b) : a.imag() > b.imag();
  });
  return values;
}

}  // namespace

std::vector<std::complex<double>> product_eigenvalues(const std::vector<MatrixXd>& factors) {
  if (factors.empty()) return {};
  const Index m = factors.front().cols();
  const bool square = std::ranges::all_of(factors, [m](const MatrixXd& F) { return F.rows() == m && F.cols() == m; });
  switch (square ? m : m > 0 ? -1 : 0) {
    case 0:
      return {};
    case 2:
      return eigenvalues<2>(factors);
    case 3:
      return eigenvalues<3>(factors);
    case 4:
      return eigenvalues<4>(factors);
    case 5:
      return eigenvalues<5>(factors);
    default:
      return eigenvalues<Eigen::Dynamic>(factors);
  }
}

}  // namespace limcycle
