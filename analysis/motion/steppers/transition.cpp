#include "limcycle/analysis/motion/steppers/transition.hpp"

#include <cmath>
#include <vector>

#include "limcycle/analysis/dense_elimination.hpp"
#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/steppers/radau_stages.hpp"

namespace limcycle {

using Eigen::Index;
using Eigen::MatrixXd;

Eigen::MatrixXd transition(LoopField& field, const Step& step) { return transition(field, step, 0, {}); }

double StageReadings::node(Index stage) { return radau_stages().c[static_cast<std::size_t>(stage)]; }
double StageReadings::weight(Index stage) { return radau_stages().a[2][static_cast<std::size_t>(stage)]; }

MatrixXd transition(LoopField& field, const Step& step, Index count, const Forcing& forcing) {
  return transition(field, step, count, forcing, nullptr);
}

MatrixXd transition(LoopField& field, const Step& step, Index count, const Forcing& forcing, StageReadings* readings) {
  const auto& [c, a] = radau_stages();
  const auto n = static_cast<Index>(field.size());
  const double h = step.t1 - step.t0;
  // Row-major, with the right sides [I; I; I] appended. Unknowns and rows component by component, the stages of each in
  // succession, so that weakly dependent components leave zeros.
  const Index m = 3 * n, right = n + count, width = m + right;
  thread_local std::vector<double> system;
  system.assign(static_cast<std::size_t>(m * width), 0.0);
  const auto at = [&](Index row, Index column) -> double& {
    return system[static_cast<std::size_t>(row * width + column)];
  };
  MatrixXd J, forced(n, count);
  State x, time;
  for (Index j = 0; j < 3; ++j) {
    const auto stage = static_cast<std::size_t>(j);
    step.interpolate(c[stage], x);
    field.jacobian(x, J, step.t0 + c[stage] * h, time);
    for (Index row = 0; row < n; ++row)
      for (Index column = 0; column < n; ++column) {
        const double change = -h * J(row, column);
        if (change == 0.0) continue;
        for (Index i = 0; i < 3; ++i) at(3 * row + i, 3 * column + j) = a[static_cast<std::size_t>(i)][stage] * change;
      }
    if (count == 0) continue;
    forcing(x, J, step.t0 + c[stage] * h, forced);
    for (Index row = 0; row < n; ++row)
      for (Index column = 0; column < count; ++column)
        for (Index i = 0; i < 3; ++i)
          at(3 * row + i, m + n + column) += h * a[static_cast<std::size_t>(i)][stage] * forced(row, column);
  }
  for (Index row = 0; row < m; ++row) {
    at(row, row) += 1.0;
    at(row, m + row / 3) = 1.0;
  }
  MatrixXd result(n, right);
  if (!eliminate(system, static_cast<std::size_t>(m), static_cast<std::size_t>(right)))
    return MatrixXd::Constant(n, right, NAN);
  for (Index row = 0; row < n; ++row)
    for (Index column = 0; column < right; ++column) result(row, column) = at(3 * row + 2, m + column);
  if (readings == nullptr) return result;
  readings->at = MatrixXd::Zero(StageReadings::count, right);
  for (Index row = 0; row < n; ++row) {
    if (readings->row(row) == 0.0) continue;
    for (Index i = 0; i < StageReadings::count; ++i)
      for (Index column = 0; column < right; ++column)
        readings->at(i, column) += readings->row(row) * at(3 * row + i, m + column);
  }
  return result;
}

}  // namespace limcycle
