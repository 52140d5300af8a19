/// @file
/// Choice of the next step size.
#pragma once

namespace limcycle {

/// Predictive step size control for a Rosenbrock method (K. Gustafsson, "Control-theoretic techniques for stepsize
/// selection in implicit Runge-Kutta methods", ACM TOMS 20, 1994; Hairer & Wanner, Solving ODEs II, IV.8): the error of
/// a step behaves as phi h^5 with phi extrapolated from the previous step. A step grows at most 6 times and shrinks at
/// most 5 times, and does not grow right after a rejection.
class StepSizeControl {
 public:
  /// Next step after an accepted one of length h with weighted error in [0, 1].
  double after_success(double h, double error);
  /// Shorter step after a rejected one of length h; error > 1, infinity for a step without a result.
  double after_failure(double h, double error);
  /// Discards the trend before another motion.
  void reset() { *this = {}; }

 private:
  double old_h_ = 0;  ///< 0: no accepted step yet
  double old_error_ = 1;
  bool rejected_ = false;
};

}  // namespace limcycle
