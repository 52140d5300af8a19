#pragma once
#include <Eigen/Core>

namespace limcycle {

/// True if one row is a multiple of the other, to rounding. A row of zeros is one of any.
inline bool parallel(const Eigen::RowVectorXd& a, const Eigen::RowVectorXd& b) {
  const double along = a.dot(b);
  return along * along >= (1.0 - 1e-12) * a.squaredNorm() * b.squaredNorm();
}

}  // namespace limcycle
