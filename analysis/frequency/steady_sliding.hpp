#pragma once
#include <vector>

#include "limcycle/models/elements.hpp"

namespace limcycle {

/// A friction law after sliding at a constant velocity for long, by implicit steps of growing length. Newton's method
/// along the diagonal is enough for the decoupled states of friction laws: it is meant as a guess, which need not be
/// exact.
template <template <class> class Kind>
struct SteadySliding {
  std::vector<double> z;
  double force = 0.0;  ///< N

  SteadySliding(const Kind<double>& law, double V) : z(static_cast<std::size_t>(law.states()), 0.0) {
    const Input<double> in{0.0, V, V < 0.0 ? -infinite : infinite};
    Mode mode{};
    if constexpr (KnowsSliding<Kind<double>>)
      mode = law.after_sliding(in, z);
    else if constexpr (HasModes<Kind<double>, double>)
      mode = law.start(in, z);
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
