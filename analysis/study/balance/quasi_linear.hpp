#pragma once
#include <complex>

#include "limcycle/models/loop.hpp"

namespace limcycle {

/// State matrix of the loop without delay in which element i acts as Re N x + (Im N/w) dx/dt on its input x, w its
/// output otherwise. The input must not depend on outputs of other elements. If no state holds a rubbing displacement,
/// a state that does is added last.
Eigen::MatrixXd quasi_linear(const Loop& loop, std::size_t i, std::complex<double> N, double w);

}  // namespace limcycle
