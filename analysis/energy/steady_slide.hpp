#pragma once
#include <optional>
#include <vector>

#include "limcycle/models/elements.hpp"
#include "limcycle/models/linear/state_space.hpp"

namespace limcycle {

/// A friction law sliding at a constant velocity, and small deviations from that.
struct SteadySlide {
  std::vector<double> z;  ///< state of the law
  Mode mode{};
  double force = 0.0;  ///< N
  /// From a small change of velocity to that of the force: the incremental damping at w is Re response.at(jw) (N s/m),
  /// at w = 0 the slope of the steady friction curve. For LuGre with V > 0 (claim B10)
  ///   sigma2 + (sigma0 + jw sigma1) (V g'/g)/(jw + sigma0 V/g).
  StateSpace response;
};

/// Sliding from no history at V (m/s, not 0), through the switches of the law: by implicit steps of growing length that
/// end as Newton's method, with the exact Jacobian. Empty if the law does not come to a steady state, or if its force
/// at this speed is one that the applied force decides, in size (a band) or by the sign of the acceleration.
std::optional<SteadySlide> steady_slide(const Element<double>& element, double V);

}  // namespace limcycle
