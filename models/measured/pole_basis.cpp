#include "limcycle/models/measured/pole_basis.hpp"

#include <cmath>

namespace limcycle {

using Eigen::Index;

int Poles::order() const {
  int order = at_zero;
  for (const auto& pole : stable) order += pole.imag() > 0.0 ? 2 : 1;
  return order;
}

PoleBasis::PoleBasis(const Poles& poles)
    : A(Eigen::MatrixXd::Zero(poles.order(), poles.order())), B(Eigen::VectorXd::Zero(poles.order())) {
  Index i = 0;
  for (; i < poles.at_zero; ++i) {
    if (i == 0)
      B(i) = 1.0;
    else
      A(i, i - 1) = 1.0;
  }
  // What drives a section: u, less the state of each one before times its weight.
  Eigen::RowVectorXd driven = Eigen::RowVectorXd::Zero(B.size());
  for (const auto& pole : poles.stable) {
    const bool pair = pole.imag() > 0.0;
    const double weight = std::sqrt((pair ? -4.0 : -2.0) * pole.real());
    A.row(i) = weight * driven;
    B(i) = weight;
    if (pair) {
      const double turn = std::abs(pole);
      A(i, i) = 2.0 * pole.real();
      A(i, i + 1) = -turn;
      A(i + 1, i) = turn;
      driven(i) = -weight;  // (s^2 - a s + b)/(s^2 + a s + b) = 1 - 2 a s/(s^2 + ...): the state is (2 a)^(1/2) s/(...)
      i += 2;
    } else {
      A(i, i) = pole.real();
      driven(i) = -weight;
      ++i;
    }
  }
}

Eigen::VectorXcd PoleBasis::at(std::complex<double> s) const {
  const Index n = size();
  Eigen::VectorXcd x(n);
  std::complex<double> drive;  // of a section: what comes from u and the states before it
  for (Index i = 0; i < n; ++i) {
    drive = B(i) + (A.row(i).head(i).cast<std::complex<double>>() * x.head(i)).value();
    if (i + 1 < n && A(i, i + 1) != 0.0) {
      const double turn = A(i + 1, i);
      x(i) = drive * s / (s * (s - A(i, i)) + turn * turn);
      x(i + 1) = turn * x(i) / s;
      ++i;
    } else {
      x(i) = drive / (s - A(i, i));
    }
  }
  return x;
}

}  // namespace limcycle
