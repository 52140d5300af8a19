#pragma once
#include <Eigen/Core>

/// @file
/// The rubbing displacement of a plant dx/dt = A x + B w, and the rubbing velocity as its rate.

namespace limcycle {

/// True if velocity x = d/dt(displacement x) for any inputs: displacement A = velocity and displacement B = 0, each
/// entry to within `accuracy` of the terms that it is the sum of.
bool is_rate_of(const Eigen::RowVectorXd& velocity, const Eigen::RowVectorXd& displacement, const Eigen::MatrixXd& A,
                const Eigen::MatrixXd& B, double accuracy);

/// The row c whose rate is the velocity (c A = velocity, c B = 0), by least squares, checked to 1e-9; the shortest if
/// there are several, which differ by parts that no input moves. Zero if no combination of the states is the integral
/// of the velocity.
Eigen::RowVectorXd integral_of(const Eigen::RowVectorXd& velocity, const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

}  // namespace limcycle
