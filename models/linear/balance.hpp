#pragma once
#include <Eigen/Core>

namespace limcycle {

/// Units of the states, powers of two, in which a matrix A is balanced: with D = diag(units), row and column k of
/// D^-1 A D have sums of like size, but for the diagonal (Parlett and Reinsch, Numer. Math. 13, 1969). A state without
/// a row or a column keeps the unit 1. Another time unit changes nothing; other units of the states change the result
/// with them, to within the powers. Cost O(n^2) a sweep.
Eigen::VectorXd balancing_units(const Eigen::MatrixXd& A);

}  // namespace limcycle
