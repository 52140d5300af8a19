/// @file
/// Polishes a guess to a simple root of two equations, with its Jacobian. (Internal to the root search.)
#pragma once

#include <Eigen/Core>
#include <complex>
#include <functional>
#include <optional>

namespace limcycle {

/// A complex function of two real variables, of order one; NaN where it is undefined.
using PlaneFunction = std::function<std::complex<double>(double p, double q)>;

/// Guess of a root and the half-widths of the cell it came from (the natural scale of both variables there).
struct RootGuess {
  double p, q;
  double scale_p, scale_q;
};

/// A root that was confirmed.
struct PolishedRoot {
  double p, q;
  Eigen::Matrix2d jacobian;  ///< d(Re, Im)/d(p, q) of the function
};

/// Polishes with GSL multiroot hybridsj (central differences for the Jacobian, steps of 1e-3 of the scale; if that
/// fails, of 0.3, for which `noise`, the bound of the error of f, counts less), then simplified Newton steps down to
/// rounding. Nothing is returned unless the last Newton step is below a tenth of the scale and below 1e-6, the sign of
/// the Jacobian determinant stands clear of the noise, and the noise moves the root by less than half the scale: a near
/// miss or a double root fails these. Also nothing when the iteration runs into NaN or ends more than 2 scales away.
/// Cost: about 15 to 30 evaluations, or twice that. What `f` throws is passed on.
std::optional<PolishedRoot> polish_root(const PlaneFunction& f, const RootGuess& guess, double noise);

}  // namespace limcycle
