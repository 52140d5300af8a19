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

namespace {

/// X = (e_(k-1), ..., e_(k-n)), without an output.
StateSpace past_inputs(Eigen::Index n) {
  using Eigen::MatrixXd;
  StateSpace past{MatrixXd::Zero(n, n), MatrixXd::Zero(n, 1), MatrixXd::Zero(1, n), MatrixXd::Zero(1, 1)};
  if (n > 0) past.B(0, 0) = 1.0;
  for (Eigen::Index i = 1; i < n; ++i) past.A(i, i - 1) = 1.0;
  return past;
}

}  // namespace

StateSpace difference_over(int n, double h) {
  StateSpace difference = past_inputs(n);
  difference.C(0, n - 1) = -1.0 / (n * h);
  difference.D(0, 0) = 1.0 / (n * h);
  return difference;
}

StateSpace windowed_difference(const Pid& pid, double h, int n) {
  using Eigen::MatrixXd;
  Pid slow = pid, fast = pid;
  slow.kd = 0.0;
  fast.kp = fast.ki = 0.0;
  // The difference over n samples is the mean of the last n differences over one.
  const StateSpace rest = backward_difference(slow.model(), h), rate = backward_difference(fast.model(), h);
  const StateSpace past = past_inputs(n - 1);
  const Eigen::Index a = rest.states(), b = rate.states(), c = past.states(), all = a + b + c;
  const double share = 1.0 / n;
  StateSpace sum{MatrixXd::Zero(all, all), MatrixXd::Zero(all, 1), MatrixXd::Zero(1, all), MatrixXd::Zero(1, 1)};
  const Eigen::RowVectorXd of_past = Eigen::RowVectorXd::Constant(c, share);
  sum.A.topLeftCorner(a, a) = rest.A;
  sum.A.block(a, a, b, b) = rate.A;
  sum.A.block(a, a + b, b, c) = rate.B * of_past;
  sum.A.bottomRightCorner(c, c) = past.A;
  sum.B << rest.B, share * rate.B, past.B;
  sum.C << rest.C, rate.C, rate.D(0, 0) * of_past;
  sum.D(0, 0) = rest.D(0, 0) + share * rate.D(0, 0);
  return sum;
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
