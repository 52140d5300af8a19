#pragma once
#include <array>
#include <cmath>

namespace limcycle {

/// Nodes and coefficients of the three-stage Radau IIA method: order 5, L-stable, the last stage is the end of the step
/// (Hairer and Wanner II, 1996, section IV.5).
struct RadauStages {
  std::array<double, 3> c;
  std::array<std::array<double, 3>, 3> a;
};

inline const RadauStages& radau_stages() {
  static const double s6 = std::sqrt(6.0);
  static const RadauStages stages{
      {(4.0 - s6) / 10.0, (4.0 + s6) / 10.0, 1.0},
      {{{(88.0 - 7.0 * s6) / 360.0, (296.0 - 169.0 * s6) / 1800.0, (-2.0 + 3.0 * s6) / 225.0},
        {(296.0 + 169.0 * s6) / 1800.0, (88.0 + 7.0 * s6) / 360.0, (-2.0 - 3.0 * s6) / 225.0},
        {(16.0 - s6) / 36.0, (16.0 + s6) / 36.0, 1.0 / 9.0}}}};
  return stages;
}

}  // namespace limcycle
