#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle::test {

/// Moves a rate-independent law with return points along a path, event by event and without any error of integration:
/// its first state moves with the input, and all guards except the first are paths left.
template <class Law>
struct PathWalk {
  Law law;
  Mode mode{};
  std::vector<double> z = std::vector<double>(static_cast<std::size_t>(law.states()), 0.0);
  double x = 0.0;
  bool begun = false;

  explicit PathWalk(Law made) : law(std::move(made)) {}

  Input<double> input(double v) const { return {x, v, v < 0.0 ? -infinite : infinite}; }

  double move(double way) {
    const Input<double> in = input(way < 0.0 ? -1.0 : 1.0);
    if (!begun) mode = law.start(in, z);
    begun = true;
    std::vector<double> g(8), rate(z.size());
    for (double left = std::abs(way); left > 0.0;) {
      const auto count = static_cast<std::size_t>(law.guards(mode));
      law.guard(in, mode, z, g);
      if (g[0] < 0.0) {
        mode = law.next(in, mode, z, 0);
        continue;
      }
      law.rate(in, mode, z, rate);
      double step = left;
      std::size_t fires = 0;
      for (std::size_t k = 1; k < count && rate[0] != 0.0; ++k)
        if (g[k] < step) {
          step = std::max(g[k], 0.0);
          fires = k;
        }
      z[0] += rate[0] * step;
      left -= step;
      if (fires > 0) mode = law.next(in, mode, z, static_cast<int>(fires));
    }
    x += way;
    return force();
  }
  double to(double target) { return move(target - x); }
  double force() const { return law.output(input(1.0), mode, z); }
};

}  // namespace limcycle::test
