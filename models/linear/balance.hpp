#pragma once
#include <Eigen/Core>

namespace limcycle {

/// Units of the states, powers of two, in which a matrix A is balanced: with D = diag(units), row and column k of
/// D^-1 A D have sums of similar size, without the diagonal (Parlett and Reinsch, Numer. Math. 13, 1969). A state with
/// an empty row or column keeps the unit 1. The result does not depend on the time unit, and follows the units of the
/// states to within the powers. Cost O(n^2) a sweep.
Eigen::VectorXd balancing_units(const Eigen::MatrixXd& A);

}  // namespace limcycle
