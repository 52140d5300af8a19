#include "limcycle/models/linear/discrete.hpp"

#include "limcycle/models/linear/dense.hpp"

namespace limcycle {

StateSpace backward_difference(const ControllerModel& controller, double h) {
  using Eigen::MatrixXd;
  const StateSpace& c = controller.ss;
  const Eigen::Index n = c.states(), all = n + (controller.D_rate != 0.0 ? 1 : 0);
  const MatrixXd identity = MatrixXd::Identity(n, n);
  const MatrixXd M = solve_columns(MatrixXd(identity - h * c.A), identity), input = M * (h * c.B);
  StateSpace discrete{MatrixXd::Zero(all, all), MatrixXd::Zero(all, 1), MatrixXd::Zero(1, all), c.D};
  discrete.A.topLeftCorner(n, n) = M;
  discrete.B.topRows(n) = input;
  discrete.C.leftCols(n) = c.C * M;
  discrete.D += c.C * input;
  if (all == n) return discrete;
  discrete.B(n, 0) = 1.0;
  discrete.C(0, n) = -controller.D_rate / h;
  discrete.D(0, 0) += controller.D_rate / h;
  return discrete;
}

StateSpace averaged(const ControllerModel& controller, double h) {
  using Eigen::MatrixXd;
  const StateSpace& c = controller.ss;
  const Eigen::Index n = c.states(), all = n + (controller.D_rate != 0.0 ? 1 : 0);
  const MatrixXd E = MatrixXd::Identity(n, n) - 0.5 * h * c.A;
  const MatrixXd A = solve_columns(E, c.A), B = solve_columns(E, c.B);
  StateSpace mean{MatrixXd::Zero(all, all), MatrixXd::Zero(all, 1), MatrixXd::Zero(1, all), c.D};
  mean.A.topLeftCorner(n, n) = A;
  mean.B.topRows(n) = B + 0.5 * h * A * B;
  mean.C.leftCols(n) = c.C;
  mean.D += 0.5 * h * c.C * B;
  if (all == n) return mean;
  // D_rate s/(1 + s h/2) = (2 D_rate/h) (1 - 1/(1 + s h/2)).
  const double gain = 2.0 * controller.D_rate / h;
  mean.A(n, n) = -2.0 / h;
  mean.B(n, 0) = 2.0 / h;
  mean.C(0, n) = -gain;
  mean.D(0, 0) += gain;
  return mean;
}

}  // namespace limcycle
