#pragma once
#include <complex>

#include "limcycle/models/loop.hpp"

namespace limcycle {

/// State matrix of the loop without delay in which element i acts as Re N x + (Im N/w) dx/dt on its input x, w its
/// output otherwise. The input must not depend on outputs of other elements. If no state holds a rubbing displacement,
/// a state that does is added last.
Eigen::MatrixXd quasi_linear(const Loop& loop, std::size_t i, std::complex<double> N, double w);

/// Response at jw from outputs added to those of the elements to the elements' inputs, n_e x n_e, while each element i
/// acts as gains(i) on its own input; with gains of zero, that of element_response. The gains are closed in the state
/// equations: through element_response, (I - H N)^-1 H would lose the digits by which H N exceeds 1, all of them for a
/// slow oscillation inside a fast loop. Exact with delay. Cost O(n^3).
Eigen::MatrixXcd quasi_linear_response(const Loop& loop, const Eigen::VectorXcd& gains, double w);

}  // namespace limcycle
