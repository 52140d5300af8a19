#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Sliding friction as it was measured: the force at some speeds, with the break-away force Fs at rest, and separate
/// values for motion in the negative direction (`velocities_minus`, `forces_minus`, `Fs_minus`, by default the same).
/// Between the points a cubic that rises and falls only where they do, C1 (Fritsch and Butland 1984, SIAM J. Sci. Stat.
/// Comput. 5(2), 300-304); beyond the last point level. Lies between the least and the largest of its points. Viscous
/// friction is in the forces. Cost O(log points).
template <class S>
struct MeasuredCurve {
  std::vector<S> velocities, forces, velocities_minus, forces_minus;
  S Fs{}, Fs_minus{};

  /// g(v), N. v = 0 counts as v >= 0.
  S level(const S& v) const {
    using std::abs;
    return level(abs(v), !(v < 0.0));
  }
  /// g at a speed >= 0 in a given direction, also for v = 0.
  S level(const S& speed, bool forward) const {
    return forward ? Side{velocities, forces, Fs}.at(speed) : Side{velocities_minus, forces_minus, Fs_minus}.at(speed);
  }

  bool symmetric() const { return Fs == Fs_minus && velocities == velocities_minus && forces == forces_minus; }
  double highest_level() const {
    return extreme([](double a, double b) { return std::max(a, b); });
  }
  double lowest_level() const {
    return extreme([](double a, double b) { return std::min(a, b); });
  }
  /// Bound of |F| for a law with |F - sigma2 v| <= highest level at speeds up to `speed`.
  double bound_with_viscous(const S& sigma2, double speed) const {
    return highest_level() + (sigma2 > 0.0 ? value_of(sigma2) * speed : 0.0);
  }
  /// The least distance of two speeds of the points.
  double velocity_scale() const {
    double least = infinite;
    for (const auto* list : {&velocities, &velocities_minus})
      for (std::size_t i = 0; i < list->size(); ++i)
        least = std::min(least, value_of((*list)[i]) - (i > 0 ? value_of((*list)[i - 1]) : 0.0));
    return least;
  }
  /// Speeds of the points of either direction, ascending.
  std::vector<double> knots() const {
    std::vector<double> list;
    for (const auto* speeds : {&velocities, &velocities_minus})
      for (const S& v : *speeds) list.push_back(value_of(v));
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  }

  template <class Owner>
  static std::vector<Parameter<Owner, S>> curve_table() {
    return {{"velocities", "m/s", "speeds of the points, ascending, above 0", &Owner::velocities, positive},
            {"forces", "N", "friction at these speeds, viscous friction included", &Owner::forces, positive},
            {"Fs", "N", "break-away (stiction) level", &Owner::Fs, positive},
            {"velocities_minus", "m/s", "speeds of the points for v < 0", &Owner::velocities_minus, positive, false,
             "velocities"},
            {"forces_minus", "N", "friction at these for v < 0", &Owner::forces_minus, positive, false, "forces"},
            {"Fs_minus", "N", "break-away level for v < 0", &Owner::Fs_minus, positive, false, "Fs"}};
  }

  std::optional<BrokenRule> validate_curve() const {
    if (auto broken = broken_points("velocities", velocities, "forces", forces)) return broken;
    return broken_points("velocities_minus", velocities_minus, "forces_minus", forces_minus);
  }

 private:
  static std::optional<BrokenRule> broken_points(const char* speed_key, const std::vector<S>& speeds,
                                                 const char* force_key, const std::vector<S>& at_speeds) {
    if (speeds.empty()) return BrokenRule{speed_key, "must have one speed or more"};
    for (std::size_t i = 1; i < speeds.size(); ++i)
      if (!(speeds[i] > speeds[i - 1])) return BrokenRule{speed_key, "must ascend from point to point"};
    if (at_speeds.size() != speeds.size())
      return BrokenRule{force_key, "must be as many as the " + std::to_string(speeds.size()) + " " + speed_key};
    return std::nullopt;
  }

  template <class F>
  double extreme(const F& of) const {
    double found = of(value_of(Fs), value_of(Fs_minus));
    for (const auto* list : {&forces, &forces_minus})
      for (const S& force : *list) found = of(found, value_of(force));
    return found;
  }

  /// The points of one direction: (0, Fs), then those measured.
  struct Side {
    const std::vector<S>& velocity;
    const std::vector<S>& force;
    const S& rest;

    std::size_t last() const { return velocity.size(); }
    S x(std::size_t i) const { return i == 0 ? S(0.0) : velocity[i - 1]; }
    S y(std::size_t i) const { return i == 0 ? rest : force[i - 1]; }
    S width(std::size_t i) const { return x(i + 1) - x(i); }
    S rise(std::size_t i) const { return (y(i + 1) - y(i)) / width(i); }

    /// Slope at an inner point: a harmonic mean, zero where the points turn.
    S inner(std::size_t i) const {
      const S before = rise(i - 1), after = rise(i);
      if (!(value_of(before) * value_of(after) > 0.0)) return S(0.0);
      const S near = S(2.0) * width(i) + width(i - 1), far = width(i) + S(2.0) * width(i - 1);
      return (near + far) / (near / before + far / after);
    }
    /// Slope at an end, from the two intervals there (`here` the outer one), kept from passing the points.
    S outer(std::size_t here, std::size_t next) const {
      const S h = width(here), k = width(next), a = rise(here), b = rise(next);
      const S slope = ((S(2.0) * h + k) * a - h * b) / (h + k);
      if (!(value_of(slope) * value_of(a) > 0.0)) return S(0.0);
      const bool turns = value_of(a) * value_of(b) <= 0.0;
      return turns && std::abs(value_of(slope)) > 3.0 * std::abs(value_of(a)) ? S(3.0) * a : slope;
    }
    S slope(std::size_t i) const {
      if (last() == 1) return rise(0);
      if (i == 0) return outer(0, 1);
      return i == last() ? outer(last() - 1, last() - 2) : inner(i);
    }
    S at(const S& speed) const {
      if (!(speed < velocity.back())) return force.back();
      const auto above =
          std::upper_bound(velocity.begin(), velocity.end(), speed, [](const S& a, const S& b) { return a < b; });
      const auto i = static_cast<std::size_t>(above - velocity.begin());
      const S h = width(i), t = (speed - x(i)) / h, u = S(1.0) - t;
      return y(i) * (S(1.0) + S(2.0) * t) * u * u + y(i + 1) * t * t * (S(1.0) + S(2.0) * u) +
             h * t * u * (slope(i) * u - slope(i + 1) * t);
    }
  };
};

}  // namespace limcycle
