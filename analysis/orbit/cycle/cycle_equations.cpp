#include "limcycle/analysis/orbit/cycle/cycle_equations.hpp"

#include "limcycle/analysis/orbit/cycle/return_map.hpp"

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
  reflect(cut, map);
  return map;
}

void reflect(const CyclePieces& cut, PeriodMap& map) {
  if (!cut.mirror) return;
  const auto& [S, centre, moved] = *cut.mirror;
  map.whole = (S.asDiagonal() * map.whole).eval();
  map.columns = (S.asDiagonal() * map.columns).eval();
  map.columns += moved - MatrixXd(S.asDiagonal() * moved);
}

std::optional<CycleMirror> common_mirror(const Loop& loop, const Cycle& cycle,
                                         std::span<const ParameterNeighbours> neighbours) {
  const auto own = symmetry(loop);
  if (!cycle.half_wave_symmetric || !own) return std::nullopt;
  const Index n = std::ssize(cycle.start.x), linear = loop.states();
  CycleMirror mirror{Reflection::signs(loop), VectorXd::Zero(n), MatrixXd::Zero(n, std::ssize(neighbours))};
  mirror.centre.head(linear) = own->centre;
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    const auto low = symmetry(neighbours[k].low), high = symmetry(neighbours[k].high);
    if (!low || !high || low->centre.size() != linear || high->centre.size() != linear) return std::nullopt;
    mirror.moved.col(static_cast<Index>(k)).head(linear) = (high->centre - low->centre) / (2.0 * neighbours[k].step);
  }
  return mirror;
}

CyclePieces cut_period(const Loop& loop, const Cycle& cycle, const std::optional<CycleMirror>& mirror,
                       ParameterRates& rates, const CutOptions& options) {
  CyclePieces cut = cut_cycle(loop, cycle.start, mirror ? 0.5 * cycle.period : cycle.period, rates, options);
  if (!mirror) return cut;
  cut.mirror = mirror;
  cut.last = Reflection{mirror->centre.head(loop.states())}.of(loop, cut.last);
  return cut;
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
