#pragma once
#include <Eigen/Core>
#include <functional>

#include "limcycle/analysis/motion/field/loop_field.hpp"

namespace limcycle {

struct Step;

/// Derivative of the state at the end of a step over the state at its start, in the field's present modes: the
/// variational equation dV/dt = J(x(t)) V, V = I at the start, along the interpolated step, by one step of the
/// three-stage Radau IIA method (L-stable: directions that contract within a step come out as nearly zero, not as
/// noise; Hairer and Wanner II, 1996, section IV.5). Order 5 for a constant J, 4 along a curve, which is interpolated.
/// Cost: three Jacobians and a linear system of 3n.
Eigen::MatrixXd transition(LoopField& field, const Step& step);

/// Forcing of deviations along a step: a column b of rates for each, at the state x where the Jacobian is J.
using Forcing = std::function<void(const State& x, const Eigen::MatrixXd& J, double t, Eigen::MatrixXd& columns)>;

/// The same, plus a column for each of `count` deviations s that start at zero under a forcing, ds/dt = J(x(t)) s +
/// b(t): by the same step of the same method.
Eigen::MatrixXd transition(LoopField& field, const Step& step, Eigen::Index count, const Forcing& forcing);

/// Values of a row applied to the deviations within the step: at the stages of the method, which are the nodes of a
/// quadrature of order 5 over the step, a row each.
struct StageReadings {
  static constexpr Eigen::Index count = 3;
  static double node(Eigen::Index stage);  ///< as a share of the step
  static double weight(Eigen::Index stage);
  Eigen::RowVectorXd row;  ///< over all states; to be set
  Eigen::MatrixXd at;      ///< its products with the columns that transition() returns, at the stages
};
/// The same, plus the readings within the step.
Eigen::MatrixXd transition(LoopField& field, const Step& step, Eigen::Index count, const Forcing& forcing,
                           StageReadings* readings);

}  // namespace limcycle
