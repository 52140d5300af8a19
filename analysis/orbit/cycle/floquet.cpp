#include "limcycle/analysis/orbit/cycle/floquet.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Reduces M by reflections (Householder): M becomes the upper triangle R, Q an orthogonal matrix of its shape, with Q
/// R = M. In plain loops: the matrices are small and many, and of many sizes.
void split(MatrixXd& M, MatrixXd& Q) {
  const Index rows = M.rows(), columns = M.cols();
  Q.setIdentity(rows, columns);
  Eigen::VectorXd factor = Eigen::VectorXd::Zero(columns);
  const auto reflect = [&](MatrixXd& target, Index column, Index k) {
    double along = target(k, column);
    for (Index i = k + 1; i < rows; ++i) along += M(i, k) * target(i, column);
    along *= factor(k);
    target(k, column) -= along;
    for (Index i = k + 1; i < rows; ++i) target(i, column) -= along * M(i, k);
  };
  for (Index k = 0; k < columns; ++k) {
    double below = 0.0;
    for (Index i = k + 1; i < rows; ++i) below = std::max(below, std::abs(M(i, k)));
    if (below == 0.0) continue;
    const double scale = std::max(below, std::abs(M(k, k)));
    double sum = 0.0;
    for (Index i = k; i < rows; ++i) sum += (M(i, k) / scale) * (M(i, k) / scale);
    const double diagonal = M(k, k) > 0.0 ? -scale * std::sqrt(sum) : scale * std::sqrt(sum);
    const double first = M(k, k) - diagonal;  // of the direction, which is kept below the diagonal in units of it
    for (Index i = k + 1; i < rows; ++i) M(i, k) /= first;
    factor(k) = -first / diagonal;
    M(k, k) = diagonal;
    for (Index j = k + 1; j < columns; ++j) reflect(M, j, k);
  }
  for (Index k = columns - 1; k >= 0; --k)
    for (Index j = k; j < columns; ++j) reflect(Q, j, k);
  for (Index k = 0; k < columns; ++k)
    for (Index i = k + 1; i < rows; ++i) M(i, k) = 0.0;
}

/// One pass of orthogonal iteration: Q enters as Q_0 and leaves as Q_K; the triangles are kept. `rounding`: entries
/// below this share of the terms they were made from are set to zero.
void pass(const std::vector<MatrixXd>& factors, MatrixXd& Q, std::vector<MatrixXd>& triangles, double rounding) {
  const Index m = Q.cols();
  triangles.resize(factors.size());
  MatrixXd moved;
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const MatrixXd& F = factors[k];
    moved = F.lazyProduct(Q);
    const double least = rounding > 0.0 ? rounding * F.cwiseAbs().lazyProduct(Q.cwiseAbs()).maxCoeff() : 0.0;
    split(moved, Q);
    MatrixXd& R = triangles[k];
    R = moved.topRows(m);
    for (Index i = 0; i < m; ++i)
      if (std::abs(R(i, i)) <= least) R(i, i) = 0.0;
  }
}

/// Eigenvalues of Z_b R_K,b ... R_1,b for the diagonal block of indices first..last.
void block_values(const MatrixXd& Z, const std::vector<MatrixXd>& triangles, Index first, Index last,
                  std::vector<std::complex<double>>& values) {
  const Index size = last - first + 1;
  MatrixXd product = MatrixXd::Identity(size, size);
  double log_scale = 0.0;
  for (const MatrixXd& R : triangles) {
    product = R.block(first, first, size, size).lazyProduct(product).eval();
    const double norm = product.cwiseAbs().maxCoeff();
    if (norm == 0.0) {
      values.insert(values.end(), static_cast<std::size_t>(size), {0.0, 0.0});
      return;
    }
    product /= norm;
    log_scale += std::log(norm);
  }
  const MatrixXd closed = Z.block(first, first, size, size).lazyProduct(product);
  for (const auto& value : limcycle::eigenvalues(closed)) values.push_back(value * std::exp(log_scale));
}

/// Two factors instead of many: the product of the triangles of one pass (each diagonal entry of which is a product of
/// numbers, and as accurate as they are), and the remaining orthogonal matrix.
std::vector<MatrixXd> condensed(const std::vector<MatrixXd>& factors) {
  const Index m = factors.front().cols();
  MatrixXd Q = MatrixXd::Identity(m, m), T = Q;
  std::vector<MatrixXd> triangles;
  pass(factors, Q, triangles, 1e-13);  // entries annihilated by a switch remain as rounding
  for (const MatrixXd& R : triangles) T = R.lazyProduct(T).eval();
  return {std::move(T), std::move(Q)};
}

}  // namespace

std::vector<std::complex<double>> product_eigenvalues(const std::vector<MatrixXd>& factors) {
  std::vector<std::complex<double>> values;
  const Index m = factors.empty() ? 0 : factors.front().cols();
  if (m == 0) return values;
  const std::vector<MatrixXd> two = condensed(factors);
  MatrixXd Q = MatrixXd::Identity(m, m), Z;
  std::vector<MatrixXd> triangles;
  for (int sweep = 0; sweep < 30; ++sweep) {
    const MatrixXd before = Q;
    pass(two, Q, triangles, 0.0);
    Z = before.transpose().lazyProduct(Q);
    double below = 0.0;
    for (Index column = 0; column < m; ++column)
      for (Index row = column + 1; row < m; ++row) below = std::max(below, std::abs(Z(row, column)));
    if (sweep > 1 && below < 1e-14) break;
  }
  for (Index first = 0; first < m;) {
    Index last = first;  // the block reaches as far as anything below the diagonal couples
    for (Index column = first; column <= last; ++column)
      for (Index row = m - 1; row > last; --row)
        if (std::abs(Z(row, column)) > 1e-10) last = row;
    block_values(Z, triangles, first, last, values);
    first = last + 1;
  }
  std::ranges::sort(values, [](auto a, auto b) {
    return std::abs(a) != std::abs(b) ? std::abs(a) > std::abs(b) : a.imag() > b.imag();
  });
  return values;
}

}  // namespace limcycle
