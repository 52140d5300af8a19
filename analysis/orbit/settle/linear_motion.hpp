#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "limcycle/analysis/motion/state.hpp"

namespace limcycle {

/// A linear motion about a steady state, in modes: x = x* + S sum of V_k xi_k exp(lambda_k t), with S the sizes of the
/// states.
struct LinearMotion {
  Eigen::VectorXd sizes;                  ///< of the states
  Eigen::MatrixXd J;                      ///< in sizes and slowest time constants
  Eigen::MatrixXcd directions, inverse;   ///< V, and the matrix from a deviation in sizes to the amounts xi
  Eigen::VectorXcd eigenvalues, amounts;  ///< lambda; xi at the present state, 0 for the neutral ones
  std::vector<bool> neutral;              ///< lambda_k = 0: the loop may rest anywhere along V_k
  double decay = 0.0;                     ///< least -Re lambda of the others
  bool settles = false;                   ///< all others decay, and nothing winds up along the neutral ones

  /// centre + S Re(V of_modes).
  State around(const State& centre, const Eigen::VectorXcd& of_modes) const;
};

/// The motion with this Jacobian and these rates at the present state (both in sizes per slowest time constant), which
/// never moves along `held` (rows in sizes). Cost O(n^4).
LinearMotion linear_motion(const Eigen::MatrixXd& J, const Eigen::VectorXd& rates, const Eigen::MatrixXd& held,
                           const Eigen::VectorXd& sizes);

/// True if these functions, affine in the state, stay positive while the motion decays to `centre`: none changes by
/// more than sum |n V_k| |xi_k|.
bool stay_positive(const std::function<void(const State& x, std::vector<double>& values)>& functions,
                   const State& centre, const LinearMotion& motion);

}  // namespace limcycle
