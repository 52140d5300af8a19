#include "limcycle/analysis/study/balance/quasi_linear.hpp"

#include "limcycle/models/linear/dense.hpp"

namespace limcycle {

Eigen::MatrixXd quasi_linear(const Loop& loop, std::size_t i, std::complex<double> N, double w) {
  const Port& port = loop.ports[i];
  const auto at = static_cast<Eigen::Index>(i), n = loop.states();
  const double damping = N.imag() / w, itself = 1.0 - damping * port.D_v(at);
  const Eigen::VectorXd B = loop.B.col(at) / itself;
  if (!port.rubs || !port.C.isZero(0.0)) return loop.A + B * (N.real() * port.C + damping * port.C_v);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n + 1, n + 1);
  matrix.topLeftCorner(n, n) = loop.A + B * damping * port.C_v;
  matrix.topRightCorner(n, 1) = B * N.real();
  matrix.bottomLeftCorner(1, n) = port.C_v / itself;
  matrix(n, n) = port.D_v(at) * N.real() / itself;
  return matrix;
}

Eigen::MatrixXcd quasi_linear_response(const Loop& loop, const Eigen::VectorXcd& gains, double w) {
  using Eigen::Index, Eigen::MatrixXcd;
  const Index n = loop.states(), ne = std::ssize(loop.elements);
  const std::complex<double> s(0.0, w), shift = std::exp(-s * loop.delay);
  MatrixXcd inputs(ne, n + ne);  // by states and by outputs
  for (Index i = 0; i < ne; ++i) {
    const Port& port = loop.ports[static_cast<std::size_t>(i)];
    const bool integrated = port.rubs && port.C.isZero(0.0);  // no state holds the rubbing displacement
    inputs.row(i).head(n) = (integrated ? port.C_v : port.C).cast<std::complex<double>>();
    inputs.row(i).tail(ne) = (integrated ? port.D_v : port.D).cast<std::complex<double>>();
    if (integrated) inputs.row(i) /= s;
    if (!integrated && loop.delay > 0.0) inputs.row(i).head(n) += shift * port.C_delayed.cast<std::complex<double>>();
  }
  // Inputs, and the elements' own outputs, by states and by added outputs.
  inputs = solve_columns(MatrixXcd::Identity(ne, ne) - inputs.rightCols(ne) * gains.asDiagonal(), inputs);
  const MatrixXcd outputs = gains.asDiagonal() * inputs;
  const auto [from, B] = loop.resolved(s);
  const MatrixXcd M = from - B * outputs.leftCols(n);
  const MatrixXcd X = solve_columns(M, B * (MatrixXcd::Identity(ne, ne) + outputs.rightCols(ne)));
  return inputs.leftCols(n) * X + inputs.rightCols(ne);
}

}  // namespace limcycle
