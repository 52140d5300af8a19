#include "limcycle/analysis/frequency/march/indifferent_map.hpp"

#include <Eigen/LU>
#include <cmath>

namespace limcycle {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// C (F C)^-2 F r for a matrix C F = M - 1 of less than full rank: its group inverse (Cline 1968). Zero where it has
/// none: then the map creeps along an indifferent direction.
VectorXd group_inverse(const Eigen::FullPivLU<MatrixXd>& lu, const VectorXd& r) {
  const Eigen::Index n = r.size(), k = lu.rank();
  MatrixXd lower = MatrixXd::Identity(n, k);
  lower.triangularView<Eigen::StrictlyLower>() = lu.matrixLU().leftCols(k);
  const MatrixXd upper = MatrixXd(lu.matrixLU().topRows(k).triangularView<Eigen::Upper>());
  const MatrixXd c = lu.permutationP().inverse() * lower, f = upper * lu.permutationQ().inverse();
  const Eigen::FullPivLU<MatrixXd> inner(f * c);
  if (!inner.isInvertible()) return VectorXd::Zero(n);
  return c * inner.solve(inner.solve(f * r));
}

}  // namespace

VectorXd indifferent_correction(const MatrixXd& m, const VectorXd& right, bool near, double& amplification) {
  const Eigen::Index n = right.size();
  Eigen::FullPivLU<MatrixXd> lu(n, n);
  lu.setThreshold(1e-11);
  lu.compute(m);
  amplification = 1.0;
  // FullPivLU measures rank against its largest pivot; a map that is indifferent in every direction has only small
  // ones.
  if (lu.rank() < n || std::abs(lu.matrixLU()(n - 1, n - 1)) < 1e-11) {
    if (!near || lu.rank() == 0 || lu.rank() == n) return VectorXd::Zero(n);
    return group_inverse(lu, right);
  }
  amplification = lu.inverse().cwiseAbs().rowwise().sum().maxCoeff();
  return lu.solve(right);
}

}  // namespace limcycle
