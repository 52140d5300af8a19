#include "limcycle/analysis/energy/passivity/held_input.hpp"

#include <cmath>

namespace limcycle {

double stepped_supply(const Element& element, const VelocityCycle& input, std::vector<double> z, Mode mode) {
  constexpr int steps = 200'000;  // per piece
  std::vector<double> rate(z.size()), guards;
  double supplied = 0.0;
  const auto settle = [&](const Input<double>& in) {
    for (int k = 0; k < 200; ++k) {
      guards.assign(static_cast<std::size_t>(element.guards(mode)), 0.0);
      element.guard(in, mode, z, guards);
      std::size_t fired = 0;
      while (fired < guards.size() && !(guards[fired] < 0.0)) ++fired;
      if (fired == guards.size()) return;
      mode = element.next(in, mode, z, static_cast<int>(fired));
    }
  };
  for (std::size_t k = 0; k + 1 < input.time.size(); ++k) {
    const double T = input.time[k + 1] - input.time[k], from = input.velocity[k], rise = input.velocity[k + 1] - from;
    if (!(T > 0.0)) continue;
    const double slope = rise / T, h = T / steps, heading = slope != 0.0 ? slope : from;
    for (int i = 0; i < steps; ++i) {
      const Input<double> in{from + rise * (i + 0.5) / steps, slope, heading < 0.0 ? -infinite : infinite};
      settle(in);
      supplied += h * in.x * element.output(in, mode, z);
      element.rate(in, mode, z, rate);
      for (std::size_t j = 0; j < z.size(); ++j) z[j] += h * rate[j];
    }
  }
  return supplied;
}

}  // namespace limcycle
