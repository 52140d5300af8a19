#include "limcycle/analysis/study/balance/quasi_linear.hpp"

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

}  // namespace limcycle
