#pragma once
#include <Eigen/Core>
#include <functional>

#include "limcycle/analysis/motion/loop_field.hpp"

namespace limcycle {

struct Step;

/// Derivative of the state at the end of a step over the state at its start, in the field's present modes: the
/// variational equation dV/dt = J(x(t)) V, V = I at the start, along the interpolated step, by one step of the
/// three-stage Radau IIA method (L-stable: directions that contract within a step come out as nearly zero, not as
/// noise; Hairer and Wanner II, 1996, section IV.5). Order 5 for a constant J, 4 along a curve, which is interpolated.
/// Cost: three Jacobians and a linear system of 3n.
Eigen::MatrixXd transition(LoopField& field, const Step& step);

/// What acts on deviations along a step: a column b of rates for each, at the state x where the Jacobian is J.
using Forcing = std::function<void(const State& x, const Eigen::MatrixXd& J, double t, Eigen::MatrixXd& columns)>;

/// The same, and beside it a column for each of `count` deviations s that start at zero under a forcing,
/// ds/dt = J(x(t)) s + b(t): by the same step of the same method.
Eigen::MatrixXd transition(LoopField& field, const Step& step, Eigen::Index count, const Forcing& forcing);

}  // namespace limcycle
