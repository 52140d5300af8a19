#pragma once
#include <vector>

#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// A friction law after long sliding at a constant velocity, by implicit steps of growing length. Newton's method with
/// the diagonal alone is enough for the decoupled states of friction laws, since the result is only a guess and need
/// not be exact.
struct SteadySliding {
  std::vector<double> z;
  double force = 0.0;  ///< N

  SteadySliding(const Element& law, double V) : z(static_cast<std::size_t>(law.states()), 0.0) {
    const Input<double> in{0.0, V, V < 0.0 ? -infinite : infinite};
    const Mode mode = law.after_sliding(in, z);
    std::vector<double> rate(z.size()), up(z.size()), shifted(z.size());
    for (int i = 0; i < 60 && !z.empty(); ++i) {
      law.rate(in, mode, z, rate);
      for (std::size_t k = 0; k < z.size(); ++k) {
        shifted = z;
        const double delta = 1e-6 * law.state_scale(static_cast<int>(k));
        shifted[k] += delta;
        law.rate(in, mode, shifted, up);
        const double slope = (up[k] - rate[k]) / delta;
        if (slope < 0.0) z[k] -= rate[k] / slope;
      }
    }
    force = law.output(in, mode, z);
  }
};

}  // namespace limcycle
