#include "limcycle/analysis/orbit/cycle_equations.hpp"

namespace limcycle {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

PeriodMap period_map(const CyclePieces& cut) {
  const Index n = cut.sizes.size(), count = cut.pieces.empty() ? 0 : cut.pieces.front().columns.cols();
  PeriodMap map{MatrixXd::Identity(n, n), MatrixXd::Zero(n, count)};
  for (const CyclePiece& piece : cut.pieces) {
    map.whole = (piece.factor * map.whole).eval();
    map.columns = (piece.factor * map.columns + piece.columns).eval();
    if (!piece.event) continue;
    map.whole = (piece.event->saltation * map.whole).eval();
    map.columns = (piece.event->saltation * map.columns + piece.event->jump).eval();
  }
  return map;
}

MatrixXd cycle_matrix(const CyclePieces& cut, const MatrixXd& whole) {
  const Index n = cut.sizes.size();
  const State& rate = cut.pieces.front().step.dx0;
  const VectorXd along = Eigen::Map<const VectorXd>(rate.data(), n).cwiseQuotient(cut.sizes).normalized();
  MatrixXd matrix(n + 1, n + 1);
  matrix.topLeftCorner(n, n) = MatrixXd::Identity(n, n);
  matrix.topLeftCorner(n, n) -= cut.sizes.cwiseInverse().asDiagonal() * whole * cut.sizes.asDiagonal();
  matrix.topRightCorner(n, 1) = -along;
  matrix.bottomLeftCorner(1, n) = along.transpose();
  matrix(n, n) = 0.0;
  return matrix;
}

bool closes(const CyclePieces& cut, const LoopState& start) {
  if (cut.last.modes != start.modes) return false;
  const auto end = Eigen::Map<const VectorXd>(cut.last.x.data(), cut.sizes.size());
  const auto begin = Eigen::Map<const VectorXd>(start.x.data(), cut.sizes.size());
  return (end - begin).cwiseQuotient(cut.sizes).cwiseAbs().maxCoeff() < 1e-4;
}

}  // namespace limcycle
