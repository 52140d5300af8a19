#include "limcycle/analysis/energy/loop/holding_forces.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "limcycle/analysis/energy/passivity/steady_slide.hpp"

namespace limcycle {
namespace {

/// Speed below which this law counts as at rest, m/s.
double creep(const Element& law) {
  const Scales scales = law.scales();
  return std::isfinite(scales.velocity) ? 1e-9 * scales.velocity : 1e-12;
}

/// Largest drive that a stuck law holds, in the direction `side`: guards change sign there.
double break_away(const Element& law, double side) {
  std::vector<double> z(static_cast<std::size_t>(law.states()), 0.0);
  const Mode mode = law.start({0.0, 0.0, 0.0}, z);
  std::vector<double> g(static_cast<std::size_t>(law.guards(mode)));
  const auto holds = [&](double force) {
    law.guard({0.0, 0.0, side * force}, mode, z, g);
    return std::ranges::all_of(g, [](double value) { return value >= 0.0; });
  };
  double low = 0.0, high = law.scales().output;
  while (holds(high) && high < 1e6 * law.scales().output) high *= 2.0;
  for (int i = 0; i < 200 && high - low > 0.0; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (holds(middle) ? low : high) = middle;
  }
  return side * low;
}

/// Output of a law that needs the applied force, at rest under a far too large one.
std::optional<double> pulled(const Element& law, double side) {
  if (!law.needs_drive()) return std::nullopt;
  const Input<double> in{0.0, 0.0, side * 1e6 * law.scales().output};
  std::vector<double> z(static_cast<std::size_t>(law.states()), 0.0);
  const Mode mode = law.start(in, z);
  return law.output(in, mode, z);
}

double slow_force(const Element& law, double side) {
  if (const auto force = pulled(law, side)) return *force;
  const auto slide = steady_slide(law, side * creep(law));
  return slide ? slide->force : 0.0;
}

}  // namespace

bool sticks(const Element& law) {
  if (!law.may_stick()) return false;
  std::vector<double> z(static_cast<std::size_t>(law.states()), 0.0);
  return law.held(law.start({0.0, 0.0, 0.0}, z)) == Held::rate;
}

Extent holding_forces(const Element& law) {
  if (sticks(law)) return {break_away(law, -1.0), break_away(law, 1.0)};
  return {slow_force(law, -1.0), slow_force(law, 1.0)};
}

Extent stopping_forces(const Element& law) { return {slow_force(law, -1.0), slow_force(law, 1.0)}; }

}  // namespace limcycle
