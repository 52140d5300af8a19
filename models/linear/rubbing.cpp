#include "limcycle/models/linear/rubbing.hpp"

#include <cmath>

#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Row = Eigen::RowVectorXd;

/// True if entries that are sums of terms of these sizes are equal to within `accuracy` of them.
bool equal(const Row& a, const Row& b, const Row& sizes, double accuracy) {
  return ((a - b).array().abs() <= accuracy * sizes.array()).all();
}

/// Reciprocal of the norm of a row, so that equations and unknowns have similar sizes; 1 for a zero row.
double scale_of(const Row& row) {
  const double size = row.norm();
  return size > 0.0 ? 1.0 / size : 1.0;
}

}  // namespace

bool is_rate_of(const Row& velocity, const Row& displacement, const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                double accuracy) {
  const Row size = displacement.cwiseAbs();
  return equal(displacement * A, velocity, size * A.cwiseAbs() + velocity.cwiseAbs(), accuracy) &&
         equal(displacement * B, Row::Zero(B.cols()), size * B.cwiseAbs(), accuracy);
}

Row integral_of(const Row& velocity, const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  const Index n = A.rows(), inputs = B.cols();
  Eigen::MatrixXd equations(n + inputs, n);
  equations << A.transpose(), B.transpose();
  Eigen::VectorXd wanted = Eigen::VectorXd::Zero(n + inputs), unit(n);
  wanted.head(n) = velocity.transpose();
  // Unknowns first: a state in millimetres has rows of A a thousand times those of one in metres.
  for (Index i = 0; i < n; ++i) {
    unit(i) = scale_of(equations.col(i).transpose());
    equations.col(i) *= unit(i);
  }
  for (Index i = 0; i < n + inputs; ++i) {
    const double scale = scale_of(equations.row(i));
    equations.row(i) *= scale;
    wanted(i) *= scale;
  }
  Eigen::VectorXd in_units = least_squares(equations, wanted, 1e-12);
  // An entry of rounding size would look like a displacement that a force moves at once.
  const double rounding = 1e-12 * in_units.norm();
  in_units = (in_units.array().abs() > rounding).select(in_units, 0.0);
  const Row found = unit.cwiseProduct(in_units).transpose();
  return is_rate_of(velocity, found, A, B, 1e-9) ? found : Row::Zero(n);
}

}  // namespace limcycle
