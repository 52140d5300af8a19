#include "limcycle/models/linear/balance.hpp"

#include <cmath>

namespace limcycle {

Eigen::VectorXd balancing_units(const Eigen::MatrixXd& A) {
  constexpr int most_sweeps = 100;
  const Eigen::Index n = A.rows();
  Eigen::MatrixXd size = A.cwiseAbs();
  size.diagonal().setZero();
  Eigen::VectorXd units = Eigen::VectorXd::Ones(n);
  bool changed = true;
  for (int sweep = 0; sweep < most_sweeps && changed; ++sweep) {
    changed = false;
    for (Eigen::Index k = 0; k < n; ++k) {
      const double column = size.col(k).sum(), row = size.row(k).sum();
      if (!(column > 0.0 && row > 0.0)) continue;
      const double factor = std::exp2(std::round(0.5 * std::log2(row / column)));
      if (factor == 1.0 || !(column * factor + row / factor < 0.95 * (column + row))) continue;
      units(k) *= factor;
      size.col(k) *= factor;
      size.row(k) /= factor;
      changed = true;
    }
  }
  return units;
}

}  // namespace limcycle
