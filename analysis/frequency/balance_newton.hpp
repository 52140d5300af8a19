#pragma once
#include <functional>

#include "limcycle/analysis/frequency/balance_equations.hpp"

namespace limcycle {

/// When Newton's method for a harmonic balance ends.
struct BalanceNewtonOptions {
  double tolerance = 1e-9;  ///< of the largest scaled residual
  int max_iterations = 30;
  std::function<bool()> stop;
};

/// What Newton's method for a harmonic balance came to.
struct BalanceSolution {
  Status status = Status::stalled;
  BalancePoint point;
  BalanceOutputs outputs;
  double residual = 0.0;  ///< largest scaled one, at `point`
};

/// Newton's method for the equations of a harmonic balance, begun at `start` (whose scales are the equations'
/// reference), with the Jacobian from the linearised panels and switches. Steps are damped until the residual falls; ln
/// w moves by 0.3 at most, the main amplitude by half.
BalanceSolution solve_balance(BalanceEquations& equations, const BalancePoint& start,
                              const BalanceNewtonOptions& options);

}  // namespace limcycle
