#pragma once
#include <optional>
#include <vector>

#include "limcycle/models/element/element.hpp"
#include "limcycle/models/linear/state_space.hpp"

namespace limcycle {

/// A friction law sliding at a constant velocity, and small deviations from that.
struct SteadySlide {
  std::vector<double> z;  ///< state of the law
  Mode mode{};
  double force = 0.0;  ///< N
  /// Transfer from a small change of velocity to that of the force: the incremental damping at w is Re response.at(jw)
  /// (N s/m), at w = 0 the slope of the steady friction curve. For LuGre with V > 0 (claim B10)
  ///   sigma2 + (sigma0 + jw sigma1) (V g'/g)/(jw + sigma0 V/g).
  StateSpace response;
};

/// Sliding at V (m/s, not 0) from no history, through the switches of the law: by implicit steps of growing length that
/// become Newton's method in the end, with the exact Jacobian. Empty if the law does not reach a steady state, or if
/// its force at this speed depends on the applied force, in size (a band) or by the sign of the acceleration.
std::optional<SteadySlide> steady_slide(const Element& element, double V);

}  // namespace limcycle
