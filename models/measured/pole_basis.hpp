#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

#include "limcycle/models/linear/state_space.hpp"

namespace limcycle {

/// Stable poles, each real one or one of a conjugate pair (imaginary part > 0), and poles at zero beside them.
struct Poles {
  std::vector<std::complex<double>> stable;
  int at_zero = 0;

  int order() const;
};

/// Functions that span all strictly proper rational functions with given poles: 1/s, 1/s^2, ... for those at zero, and
/// for the others the orthonormal ones of Takenaka and Malmquist, in the real form of Kautz: each is a section of first
/// or second order behind the all-pass of those before. They stay independent where poles meet, which partial fractions
/// do not (Deschrijver, Haegeman and Dhaene, IEEE Trans. Adv. Packag. 30, 2007).
///
/// States: dx/dt = A x + B u, the functions being those from u to x; A is lower triangular but for the pairs.
struct PoleBasis {
  Eigen::MatrixXd A;
  Eigen::VectorXd B;

  explicit PoleBasis(const Poles& poles);

  Eigen::Index size() const { return B.size(); }

  /// All functions at s, s not among the poles nor 0; cost O(n^2).
  Eigen::VectorXcd at(std::complex<double> s) const;
};

}  // namespace limcycle
