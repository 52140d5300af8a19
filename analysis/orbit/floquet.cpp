#include "limcycle/analysis/orbit/floquet.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// One pass of orthogonal iteration: Q goes in as Q_0 and comes out as Q_K; the triangles are kept.
void pass(const std::vector<MatrixXd>& factors, MatrixXd& Q, std::vector<MatrixXd>& triangles) {
  const Index m = Q.cols();
  triangles.clear();
  for (const MatrixXd& F : factors) {
    const MatrixXd moved = F * Q;
    const Eigen::HouseholderQR<MatrixXd> qr(moved);
    MatrixXd R = MatrixXd::Zero(m, m);
    R.triangularView<Eigen::Upper>() = qr.matrixQR().topRows(m);
    // What a switch annihilates is left as rounding of what it was made from.
    const double rounding = 1e-13 * (F.cwiseAbs() * Q.cwiseAbs()).maxCoeff();
    for (Index i = 0; i < m; ++i)
      if (std::abs(R(i, i)) <= rounding) R(i, i) = 0.0;
    Q = qr.householderQ() * MatrixXd::Identity(moved.rows(), m);
    triangles.push_back(std::move(R));
  }
}

/// Eigenvalues of Z_b R_K,b ... R_1,b for the diagonal block of indices first..last.
void block_values(const MatrixXd& Z, const std::vector<MatrixXd>& triangles, Index first, Index last,
                  std::vector<std::complex<double>>& values) {
  const Index size = last - first + 1;
  MatrixXd product = MatrixXd::Identity(size, size);
  double log_scale = 0.0;
  for (const MatrixXd& R : triangles) {
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

}  // namespace

std::vector<std::complex<double>> product_eigenvalues(const std::vector<MatrixXd>& factors) {
  std::vector<std::complex<double>> values;
  if (factors.empty() || factors.front().cols() == 0) return values;
  const Index m = factors.front().cols();
  MatrixXd Q = MatrixXd::Identity(m, m), Z;
  std::vector<MatrixXd> triangles;
  for (int sweep = 0; sweep < 30; ++sweep) {
    const MatrixXd before = Q;
    pass(factors, Q, triangles);
    Z = before.transpose() * Q;
    if (sweep > 1 && Z.triangularView<Eigen::StrictlyLower>().toDenseMatrix().cwiseAbs().maxCoeff() < 1e-14) break;
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
