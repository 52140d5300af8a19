#pragma once
#include <Eigen/Core>

namespace limcycle {

/// (1 - M)^-1 r for `m` = M - 1 and `right` = -r, in units of the states. States that the map keeps, whatever the
/// others are (return points that no loop reaches any more), stay as they are, if |r| is below a hundredth. Where M has
/// other indifferent directions, the group inverse of 1 - M, which leaves them alone, if `near` the end. Else zero:
/// there the map itself must lead on. `amplification`: largest row sum of the inverse, 1 where there is none. Cost
/// O(n^3).
Eigen::VectorXd indifferent_correction(const Eigen::MatrixXd& m, const Eigen::VectorXd& right, bool near,
                                       double& amplification);

}  // namespace limcycle
