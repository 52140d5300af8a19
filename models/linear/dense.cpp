#include "limcycle/models/linear/dense.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <unsupported/Eigen/MatrixFunctions>

namespace limcycle {

Eigen::MatrixXd exponential(const Eigen::MatrixXd& A) { return A.exp(); }

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A) { return A.eigenvalues(); }

EigenPairs eigen_pairs(const Eigen::MatrixXd& A) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Singular<Eigen::MatrixXd> singular_values(const Eigen::MatrixXd& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeFullU);
  return {svd.singularValues(), svd.matrixU(), {}};
}

Singular<Eigen::MatrixXcd> singular_values(const Eigen::MatrixXcd& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXcd> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixU(), svd.matrixV()};
}

PivotedQr pivoted_qr(const Eigen::MatrixXd& A, std::optional<double> threshold) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A.rows(), A.cols());
  if (threshold) qr.setThreshold(*threshold);
  qr.compute(A);
  return {qr.householderQ() * Eigen::MatrixXd::Identity(A.rows(), A.rows()), qr.matrixR(), qr.rank()};
}

Eigen::VectorXd solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) { return A.partialPivLu().solve(b); }

Eigen::VectorXcd solve(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& b) { return A.partialPivLu().solve(b); }

Eigen::MatrixXd solve_columns(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) { return A.partialPivLu().solve(B); }

Eigen::MatrixXcd solve_columns(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& B) {
  return A.partialPivLu().solve(B);
}

Eigen::VectorXd solve_fully_pivoted(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  Eigen::VectorXd x;
  solve_fully_pivoted(A, b, x);
  return x;
}

void solve_fully_pivoted(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  if (A.size() != 1) {
    x = A.fullPivLu().solve(b);
    return;
  }
  x.resize(1);
  x(0) = A(0, 0) == 0.0 ? 0.0 : b(0) / A(0, 0);
}

Eigen::VectorXcd solve_fully_pivoted(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& b) {
  return A.fullPivLu().solve(b);
}

Eigen::Index rank(const Eigen::MatrixXd& A) { return A.fullPivLu().rank(); }

Eigen::MatrixXd kernel(const Eigen::MatrixXd& A) {
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(A);
  return lu.dimensionOfKernel() == 0 ? Eigen::MatrixXd(A.cols(), 0) : Eigen::MatrixXd(lu.kernel());
}

std::optional<Eigen::MatrixXcd> solve_if_regular(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& B,
                                                 double least_rcond) {
  const Eigen::PartialPivLU<Eigen::MatrixXcd> lu(A);
  if (!(lu.rcond() > least_rcond)) return std::nullopt;
  return lu.solve(B);
}

Eigen::MatrixXd solve_columns_fully_pivoted(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A.fullPivLu().solve(B);
}

void equilibrate(Eigen::MatrixXd& A, Eigen::VectorXd& b) {
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    const double size = A.row(i).norm();
    if (size == 0.0) continue;
    A.row(i) /= size;
    b(i) /= size;
  }
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, std::optional<double> threshold) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> system;
  if (threshold) system.setThreshold(*threshold);
  return system.compute(A).solve(b);
}

Eigen::MatrixXd least_squares_columns(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A.completeOrthogonalDecomposition().solve(B);
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A) { return A.completeOrthogonalDecomposition().pseudoInverse(); }

}  // namespace limcycle
