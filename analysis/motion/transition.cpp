#include "limcycle/analysis/motion/transition.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>

#include "limcycle/analysis/motion/march.hpp"

namespace limcycle {

using Eigen::Index;
using Eigen::MatrixXd;

Eigen::MatrixXd transition(LoopField& field, const Step& step) {
  const double s6 = std::sqrt(6.0);
  const std::array<double, 3> c{(4.0 - s6) / 10.0, (4.0 + s6) / 10.0, 1.0};
  const std::array<std::array<double, 3>, 3> a{
      {{(88.0 - 7.0 * s6) / 360.0, (296.0 - 169.0 * s6) / 1800.0, (-2.0 + 3.0 * s6) / 225.0},
       {(296.0 + 169.0 * s6) / 1800.0, (88.0 + 7.0 * s6) / 360.0, (-2.0 - 3.0 * s6) / 225.0},
       {(16.0 - s6) / 36.0, (16.0 + s6) / 36.0, 1.0 / 9.0}}};
  const auto n = static_cast<Index>(field.size());
  const double h = step.t1 - step.t0;
  MatrixXd system = MatrixXd::Identity(3 * n, 3 * n), right(3 * n, n), J;
  State x, time;
  for (std::size_t j = 0; j < 3; ++j) {
    step.interpolate(c[j], x);
    field.jacobian(x, J, step.t0 + c[j] * h, time);
    for (std::size_t i = 0; i < 3; ++i)
      system.block(static_cast<Index>(i) * n, static_cast<Index>(j) * n, n, n) -= h * a[i][j] * J;
    right.middleRows(static_cast<Index>(j) * n, n).setIdentity();
  }
  return system.partialPivLu().solve(right).bottomRows(n);
}

}  // namespace limcycle
