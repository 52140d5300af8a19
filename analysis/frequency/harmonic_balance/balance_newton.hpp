#pragma once
#include <functional>

#include "limcycle/analysis/frequency/harmonic_balance/balance_equations.hpp"

namespace limcycle {

/// Stopping criteria of Newton's method for a harmonic balance.
struct BalanceNewtonOptions {
  double tolerance = 1e-9;  ///< of the largest scaled residual
  int max_iterations = 30;
  std::function<bool()> stop;
};

/// Result of Newton's method for a harmonic balance.
struct BalanceSolution {
  Status status = Status::stalled;
  BalancePoint point;
  BalanceOutputs outputs;
  double residual = 0.0;  ///< largest scaled one, at `point`
};

/// Newton's method for the equations of a harmonic balance, started at `start` (whose scales are the equations'
/// reference), with the Jacobian from the linearised panels and switches. Steps are damped until the residual falls; ln
/// w changes by at most 0.3 and the main amplitude by at most half per step.
BalanceSolution solve_balance(BalanceEquations& equations, const BalancePoint& start,
                              const BalanceNewtonOptions& options);

}  // namespace limcycle
