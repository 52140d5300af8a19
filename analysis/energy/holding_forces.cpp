#include "limcycle/analysis/energy/holding_forces.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "limcycle/analysis/energy/steady_slide.hpp"

namespace limcycle {
namespace {

/// Speed that counts as none for this law, m/s.
double creep(const Element<double>& law) {
  const Scales scales = scales_of(law);
  return std::isfinite(scales.velocity) ? 1e-9 * scales.velocity : 1e-12;
}

/// Largest drive that a stuck law holds, in the direction `side`: guards change sign there.
double break_away(const Element<double>& law, double side) {
  return std::visit(
      [&]<class E>(const E& e) -> double {
        if constexpr (CanHold<E> && HasModes<E, double>) {
          std::vector<double> z(static_cast<std::size_t>(e.states()), 0.0);
          const Mode mode = e.start({0.0, 0.0, 0.0}, z);
          std::vector<double> g(static_cast<std::size_t>(e.guards(mode)));
          const auto holds = [&](double force) {
            e.guard({0.0, 0.0, side * force}, mode, z, g);
            return std::ranges::all_of(g, [](double value) { return value >= 0.0; });
          };
          double low = 0.0, high = e.scales().output;
          while (holds(high) && high < 1e6 * e.scales().output) high *= 2.0;
          for (int i = 0; i < 200 && high - low > 0.0; ++i) {
            const double middle = 0.5 * (low + high);
            if (middle == low || middle == high) break;
            (holds(middle) ? low : high) = middle;
          }
          return side * low;
        }
        return 0.0;
      },
      law);
}

/// Output of a law that knows the applied force, at rest under one that is far too much for it.
std::optional<double> pulled(const Element<double>& law, double side) {
  return std::visit(
      [&]<class E>(const E& e) -> std::optional<double> {
        if constexpr (NeedsDrive<E>) {
          const Input<double> in{0.0, 0.0, side * 1e6 * e.scales().output};
          std::vector<double> z(static_cast<std::size_t>(e.states()), 0.0);
          Mode mode{};
          if constexpr (HasModes<E, double>) mode = e.start(in, z);
          return e.output(in, mode, z);
        }
        return std::nullopt;
      },
      law);
}

double slow_force(const Element<double>& law, double side) {
  if (const auto force = pulled(law, side)) return *force;
  const auto slide = steady_slide(law, side * creep(law));
  return slide ? slide->force : 0.0;
}

}  // namespace

bool sticks(const Element<double>& law) {
  return std::visit(
      []<class E>(const E& e) {
        if constexpr (CanHold<E>) {
          std::vector<double> z(static_cast<std::size_t>(e.states()), 0.0);
          return E::holds == Held::rate && e.held(e.start({0.0, 0.0, 0.0}, z)) == Held::rate;
        }
        return false;
      },
      law);
}

Extent holding_forces(const Element<double>& law) {
  if (sticks(law)) return {break_away(law, -1.0), break_away(law, 1.0)};
  return {slow_force(law, -1.0), slow_force(law, 1.0)};
}

Extent stopping_forces(const Element<double>& law) { return {slow_force(law, -1.0), slow_force(law, 1.0)}; }

}  // namespace limcycle
