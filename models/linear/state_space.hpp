#pragma once
#include <Eigen/Core>
#include <complex>
#include <span>
#include <vector>

namespace limcycle {

/// dx/dt = A x + B u, y = C x + D u.
struct StateSpace {
  Eigen::MatrixXd A, B, C, D;

  Eigen::Index states() const { return A.rows(); }

  /// G(s) = C (sI - A)^-1 B + D by LU; cost O(n^3).
  Eigen::MatrixXcd at(std::complex<double> s) const;
};

/// True if the product C B is zero to rounding of its terms: B does not change C x at once.
bool does_not_reach(const Eigen::RowVectorXd& C, const Eigen::VectorXd& B);

/// Single-input single-output realisation of numerator/denominator (highest power first) in controllable form, with the
/// time scaled so that the coefficients are balanced. Throws std::invalid_argument if it is improper or empty.
StateSpace realise(std::span<const double> numerator, std::span<const double> denominator);

/// Realisation of gain prod(s - zeros)/prod(s - poles) as a chain of first- and second-order sections; complex zeros
/// and poles must come in conjugate pairs. Throws std::invalid_argument otherwise or if there are more zeros than
/// poles.
StateSpace realise_zpk(std::vector<std::complex<double>> zeros, std::vector<std::complex<double>> poles, double gain);

}  // namespace limcycle
