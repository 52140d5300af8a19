#include "limcycle/analysis/frequency/march/indifferent_map.hpp"

#include <Eigen/LU>
#include <cmath>
#include <vector>

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

/// The states that the map changes, or would change from elsewhere: the others keep their values whatever the rest is.
std::vector<Eigen::Index> changed_states(const MatrixXd& m, const VectorXd& right) {
  std::vector<Eigen::Index> changed;
  for (Eigen::Index p = 0; p < right.size(); ++p)
    if (right(p) != 0.0 || !m.row(p).isZero(0.0)) changed.push_back(p);
  return changed;
}

VectorXd correction_of(const MatrixXd& m, const VectorXd& right, bool near, double& amplification) {
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

}  // namespace

VectorXd indifferent_correction(const MatrixXd& m, const VectorXd& right, bool near, double& amplification) {
  const std::vector<Eigen::Index> changed = changed_states(m, right);
  VectorXd step = VectorXd::Zero(right.size());
  amplification = 1.0;
  // Farther away the motion may still reach what is kept so far.
  constexpr double close = 1e-2;
  if (std::ssize(changed) < right.size() && right.cwiseAbs().maxCoeff() > close) return step;
  if (!changed.empty()) step(changed) = correction_of(m(changed, changed), right(changed), near, amplification);
  return step;
}

}  // namespace limcycle
