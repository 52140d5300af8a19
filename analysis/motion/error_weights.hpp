/// @file
/// Error norm of a step: the tolerances, and the norm used by every stepper in this folder.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "limcycle/analysis/motion/state.hpp"

namespace limcycle {

/// Tolerances of a step: component i may be wrong by atol[i] + rtol max(|x_old[i]|, |x_new[i]|), both measured from
/// `origin`.
///
/// One absolute tolerance for all components is wrong for friction: sticking creeps at 1e-6 to 1e-4 m/s, and a step
/// that may miss that breaks stiction early and settles on a false but plausible cycle. Use atol = tol vs for a
/// velocity (vs: Stribeck velocity) and state the bristle force, not the bristle deflection.
struct ErrorWeights {
  double rtol = 0;    ///< relative tolerance, 0 or more, finite
  State atol;         ///< absolute tolerance of each component, more than 0, finite, in the component's own unit
  State origin = {};  ///< value of each component from which its size counts; empty: 0
  double time = 1.0;  ///< s, a time scale of the whole motion: times are short or long to the march relative to it

  /// Throws std::invalid_argument, quoting the value, unless every tolerance is in its range and there is at least one.
  void require_valid() const;

  /// Throws std::invalid_argument unless there is one tolerance for each of n components.
  void require_size(std::size_t n) const;

  /// The same for another relative tolerance, with the absolute ones in proportion.
  ErrorWeights scaled_to(double other_rtol) const {
    ErrorWeights other{other_rtol, atol, origin, time};
    for (double& value : other.atol) value *= other_rtol / rtol;
    return other;
  }

  /// How large component i is.
  double size(std::size_t i, double value) const { return std::abs(origin.empty() ? value : value - origin[i]); }

  /// Largest weighted error, max_i |error[i]| / (atol[i] + rtol max(|x_old[i]|, |x_new[i]|)); a step is good if this is
  /// at most 1. +infinity if any component of the error or of x_new is NaN or infinite, so that `norm <= 1` and
  /// `norm > 1` both reject such a step (an infinite x_new would otherwise get an infinite allowance).
  /// The three states must have the size of atol.
  double norm(const State& x_old, const State& x_new, const State& error) const;
};

/// The same norm as an error checker of odeint::controlled_runge_kutta. Odeint 1.74 rejects if `error > 1`, which a NaN
/// passes: the step is accepted and the step size grows. Here a NaN counts as +infinity.
///
/// An explicit stepper's checker does not receive x_new, which is replaced by x_old + dt dxdt_old in the allowance. A
/// right side that hides its own NaN from every stage of the error formula cannot be seen here (the step after it is
/// rejected, as its x_old is NaN), so the caller should check the state too.
class WeightedErrorChecker {
 public:
  using value_type = double;

  /// Throws std::invalid_argument as ErrorWeights::require_valid does.
  explicit WeightedErrorChecker(ErrorWeights weights) : weights_(std::move(weights)) { weights_.require_valid(); }

  const ErrorWeights& weights() const { return weights_; }

  /// Weighted error of a step of length dt from x_old (rate dxdt_old) with error estimate x_err.
  /// Throws std::invalid_argument if the sizes differ.
  template <class Algebra, class StateLike, class Rate, class Error, class Time>
  double error(Algebra& /*algebra*/, const StateLike& x_old, const Rate& dxdt_old, const Error& x_err, Time dt) const {
    weights_.require_size(x_old.size());
    double worst = 0;
    for (std::size_t i = 0; i < x_old.size(); ++i) {
      const double reach = std::max(weights_.size(i, x_old[i]), weights_.size(i, x_old[i] + dt * dxdt_old[i]));
      const double ratio = std::abs(x_err[i]) / (weights_.atol[i] + weights_.rtol * reach);
      if (!std::isfinite(ratio) || !std::isfinite(reach)) return std::numeric_limits<double>::infinity();
      worst = std::max(worst, ratio);
    }
    return worst;
  }

 private:
  ErrorWeights weights_;
};

}  // namespace limcycle
