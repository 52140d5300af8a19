#pragma once
#include <Eigen/Core>
#include <optional>

/// @file
/// Dense linear algebra that many ask for, behind plain functions: each decomposition of Eigen takes the compiler
/// seconds, under sanitizers tens of them, and is compiled here once. Small matrices of a size known when compiling,
/// and decompositions that are asked more than one question, use Eigen itself. Cost of each: O(n^3).

namespace limcycle {

/// Eigenvalues of a square matrix, in no order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);

/// x with A x = b, for a regular matrix: rows are pivoted.
Eigen::VectorXd solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
Eigen::VectorXcd solve(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& b);
/// The same for each column of B.
Eigen::MatrixXcd solve_columns(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& B);

/// The same by full pivoting, for a matrix that may be singular, when something is zero in x.
Eigen::VectorXd solve_fully_pivoted(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
Eigen::MatrixXd solve_columns_fully_pivoted(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// The shortest x for which |A x - b| is least. Pivots below `threshold` times the largest count as zero; without it,
/// those that are rounding.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, std::optional<double> threshold = {});

/// The matrix that takes b to that x.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A);

}  // namespace limcycle
