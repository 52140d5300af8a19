#pragma once
#include "limcycle/analysis/cycle.hpp"

namespace limcycle {

/// An integral and its estimated absolute error.
struct SquaredError {
  double value = 0.0, error = 0.0;
};

/// Integral of (reference - y)^2 over the first `horizon` seconds of a run, in s times the square of y's unit; after
/// its last sample y stays where it is. Between two samples y is the cubic with their values and rates, whose square is
/// integrated exactly: the error falls with the fourth power of the sampling interval. It is estimated as a fifteenth
/// of the change when every second sample is left out. Zero without samples. Cost: linear in the samples.
SquaredError squared_error(const Trace& run, double reference, double horizon);

}  // namespace limcycle
