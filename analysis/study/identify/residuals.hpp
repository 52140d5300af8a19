#pragma once
#include <span>

namespace limcycle {

/// Whether what a fit leaves over looks like noise.
struct Whiteness {
  double autocorrelation = 0.0;  ///< of neighbouring rows
  /// Probability of autocorrelations this large in white noise, over ten lags (Ljung and Box 1978); less than 0.001
  /// says that the law misses something that the record shows.
  double probability = 1.0;
};

/// Of residuals in the order of time, or of velocity for steady velocities. Fewer than 20 values: probability 1.
Whiteness whiteness(std::span<const double> residuals);

}  // namespace limcycle
