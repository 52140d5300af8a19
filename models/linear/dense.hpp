#pragma once
#include <Eigen/Core>
#include <optional>

/// @file
/// Dense linear algebra behind plain functions: each decomposition of Eigen takes seconds to compile, under sanitizers
/// tens of seconds, and is compiled once here. Small matrices of a size known at compile time, and decompositions that
/// are used more than once, use Eigen itself. Cost of each: O(n^3).

namespace limcycle {

/// exp(A), by Pade approximations (Higham 2005, as implemented in Eigen): independent of AffineFlow, to test claims.
Eigen::MatrixXd exponential(const Eigen::MatrixXd& A);

/// Eigenvalues of a square matrix, in no particular order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);

/// Eigenvalues of a square matrix and its right eigenvectors as columns.
struct EigenPairs {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};
EigenPairs eigen_pairs(const Eigen::MatrixXd& A);

/// A = U diag(values) V*, values in descending order; U and V are square. V is empty for a real matrix.
template <class Matrix>
struct Singular {
  Eigen::VectorXd values;
  Matrix U, V;
};
Singular<Eigen::MatrixXd> singular_values(const Eigen::MatrixXd& A);
Singular<Eigen::MatrixXcd> singular_values(const Eigen::MatrixXcd& A);

/// A P = Q R by Householder reflections, columns pivoted; Q is square, `rank` the number of pivots above `threshold`
/// times the largest; without it, above rounding.
struct PivotedQr {
  Eigen::MatrixXd Q, R;
  Eigen::Index rank = 0;
};
PivotedQr pivoted_qr(const Eigen::MatrixXd& A, std::optional<double> threshold = {});

/// x with A x = b, for a regular matrix, with row pivoting.
Eigen::VectorXd solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
Eigen::VectorXcd solve(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& b);
/// The same for each column of B.
Eigen::MatrixXd solve_columns(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);
Eigen::MatrixXcd solve_columns(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& B);

/// The same by full pivoting, for a matrix that may be singular, when something is zero in x.
Eigen::VectorXd solve_fully_pivoted(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
/// Into x, without memory of its own for a single equation; x must not be b.
void solve_fully_pivoted(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, Eigen::VectorXd& x);
Eigen::VectorXcd solve_fully_pivoted(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& b);
Eigen::MatrixXd solve_columns_fully_pivoted(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// Rank by full pivoting: the number of pivots above rounding.
Eigen::Index rank(const Eigen::MatrixXd& A);

/// Columns that span all x with A x = 0, by full pivoting; none if A is regular.
Eigen::MatrixXd kernel(const Eigen::MatrixXd& A);

/// X with A X = B, unless the estimate of the reciprocal condition of A is `least_rcond` or less.
std::optional<Eigen::MatrixXcd> solve_if_regular(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& B,
                                                 double least_rcond);

/// Divides each equation of A x = b by the length of its row of A, except where that is 0, so that least squares weigh
/// all alike.
void equilibrate(Eigen::MatrixXd& A, Eigen::VectorXd& b);

/// The shortest x that minimises |A x - b|. Pivots below `threshold` times the largest count as zero; without it, those
/// of rounding size.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, std::optional<double> threshold = {});

/// The same for each column of B.
Eigen::MatrixXd least_squares_columns(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// The matrix that maps b to that x.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A);

}  // namespace limcycle
