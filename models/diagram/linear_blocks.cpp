#include "limcycle/models/diagram/linear_blocks.hpp"

#include "limcycle/models/linear/controllers.hpp"

namespace limcycle {
namespace {

/// One input, one output, `n` states, all zero.
LinearModel sized(Eigen::Index n) {
  LinearModel model;
  model.ss = {Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, 1), Eigen::MatrixXd::Zero(1, n),
              Eigen::MatrixXd::Zero(1, 1)};
  return model;
}

std::vector<std::string> numbered(Eigen::Index n) {
  std::vector<std::string> names;
  for (Eigen::Index i = 0; i < n; ++i) names.push_back("x" + std::to_string(i + 1));
  return names;
}

LinearModel first_order(double time, double gain) {
  LinearModel model = sized(1);
  model.ss.A(0, 0) = -1.0;
  model.ss.B(0, 0) = gain;
  model.ss.C(0, 0) = 1.0;
  model.time = time;
  model.state_names = {"u_lag"};
  return model;
}

/// The controller of the slots that has the same equation and the same rules.
TransferFunctionController as_controller(const ProperTransferFunction& block) {
  TransferFunctionController controller;
  controller.numerator = block.numerator;
  controller.denominator = block.denominator;
  return controller;
}

}  // namespace

LinearModel Gain::model() const {
  LinearModel one = sized(0);
  one.ss.D(0, 0) = gain;
  return one;
}

LinearModel SumBlock::model() const { return Gain{1.0}.model(); }

LinearModel Integrator::model() const {
  LinearModel one = sized(1);
  one.ss.A(0, 0) = -leak;
  one.ss.B(0, 0) = gain;
  one.ss.C(0, 0) = 1.0;
  one.state_names = {"y"};
  return one;
}

LinearModel LowPass::model() const { return first_order(time_constant, gain); }

LinearModel LeadLag::model() const {  // state: the input, low-passed
  LinearModel one = first_order(lag, 1.0);
  one.ss.D(0, 0) = gain * (lead / lag);
  one.ss.C(0, 0) = gain * (1.0 - lead / lag);
  return one;
}

LinearModel Notch::model() const {  // states in units of one period over 2 pi
  LinearModel one = sized(2);
  one.ss.A << 0.0, 1.0, -1.0, -2.0 * damping;
  one.ss.B << 0.0, 1.0;
  one.ss.C << 0.0, 2.0 * (depth - 1.0) * damping;
  one.ss.D(0, 0) = 1.0;
  one.time = 1.0 / frequency;
  one.state_names = {"x", "dx"};
  return one;
}

std::optional<BrokenRule> ProperTransferFunction::validate() const { return as_controller(*this).validate(); }

LinearModel ProperTransferFunction::model() const {
  LinearModel one;
  one.ss = as_controller(*this).model().ss;
  one.state_names = numbered(one.ss.states());
  return one;
}

std::optional<BrokenRule> StateSpaceBlock::validate() const {
  const auto n = A.rows();
  if (A.cols() != n) return BrokenRule{"A", "must be square"};
  if (B.rows() != n || B.cols() < 1) return BrokenRule{"B", "must have as many rows as A, and one column an input"};
  if (C.cols() != n || C.rows() < 1) return BrokenRule{"C", "must have as many columns as A, and one row an output"};
  if (D.size() != 0 && (D.rows() != C.rows() || D.cols() != B.cols()))
    return BrokenRule{"D", "must have one row an output and one column an input"};
  return std::nullopt;
}

LinearModel StateSpaceBlock::model() const {
  LinearModel one;
  one.ss = {A, B, C, D.size() != 0 ? D : Eigen::MatrixXd(Eigen::MatrixXd::Zero(C.rows(), B.cols()))};
  one.state_names = numbered(A.rows());
  return one;
}

LinearModel model_of(const LinearBlock& block) {
  return std::visit(
      []<class Kind>(const Kind& kind) {
        if constexpr (requires { kind.model(); })
          return kind.model();
        else  // a constant, a delay: no states
          return LinearModel{
              .ss = {Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 1), Eigen::MatrixXd(1, 0), Eigen::MatrixXd::Zero(1, 1)},
              .state_names = {}};
      },
      block);
}

}  // namespace limcycle
