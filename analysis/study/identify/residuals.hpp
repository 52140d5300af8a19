#pragma once
#include <limits>
#include <span>

namespace limcycle {

/// Whether what a fit leaves over looks like noise.
struct Whiteness {
  double autocorrelation = 0.0;  ///< of neighbouring rows
  /// Probability of autocorrelations this large in white noise of mean 0, over ten lags (Ljung and Box 1978); less than
  /// 0.001 says that the law misses something that the record shows. NaN: not tested.
  double probability = std::numeric_limits<double>::quiet_NaN();
};

/// Of residuals in the order of time, or of velocity for steady velocities. Fewer than 20 values are not tested.
Whiteness whiteness(std::span<const double> residuals);

}  // namespace limcycle
