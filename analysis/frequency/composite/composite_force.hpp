#pragma once
#include <vector>

namespace limcycle {

/// Force on mass and friction together: bias + amplitude sin(phase), phase = frequency t.
struct CompositeForce {
  double bias = 0.0;       ///< N
  double amplitude = 0.0;  ///< N
  double frequency = 1.0;  ///< rad/s
};

/// Quantities summed along a march: integrals over time, and extremes.
struct CompositeSums {
  int orders = 1;
  double displacement = 0.0;         ///< integral of v
  double work = 0.0;                 ///< integral of F v
  std::vector<double> sine, cosine;  ///< [k-1]: integrals of v sin(k phase), v cos(k phase)
  double stuck = 0.0;                ///< phase (rad) that is stuck, or slower than a hundredth of the velocity scale
  double peak_speed = 0.0;           ///< largest |v| at the end of a step
};

/// Sizes against which errors are measured: m/s for v; the states have their own.
struct CompositeTolerance {
  double relative = 1e-6;
  double velocity = 1.0;  ///< absolute tolerance of v is relative times this
  double length = 1.0;    ///< and of the integrals of v, this
};

}  // namespace limcycle
