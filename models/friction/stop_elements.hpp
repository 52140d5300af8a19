#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// @file
/// Parallel elements, each a spring and a slider in series, which stick or slip; two bits of the mode each.

enum class Slider : std::int64_t { sticks = 0, slips_forward = 1, slips_backward = 2 };

/// Largest number that fits into one mode, with a bit to spare for the law.
inline constexpr int most_sliders = 31;

/// A guard value `left` that is negative by less than this share of its size counts as 0. When the motion reverses
/// every slipping element stands on its limit, and rounding there must not let it slip in the wrong direction; an
/// element that moves on outwards slips at once, since its guard is 0 already.
inline constexpr double slider_slack = 1e-12;

template <class S>
S without_roundings(const S& left, double size) {
  const double value = value_of(left);
  return value < 0.0 && value >= -slider_slack * size ? left - S(value) : left;
}

/// True if the motion at `in` is forwards or about to be, for an element whose output is `output`.
template <class S>
bool moves_forward(const Input<S>& in, const S& output) {
  return in.v > 0.0 || (in.v == 0.0 && in.drive > output);
}

namespace slider_bits {
inline constexpr std::int64_t forward = 0x1555555555555555, backward = 0x2AAAAAAAAAAAAAAA, all = forward | backward;
}

inline Slider slider(Mode mode, int i) { return static_cast<Slider>((mode.value >> (2 * i)) & 3); }

inline Mode with_slider(Mode mode, int i, Slider slider) {
  const std::int64_t cleared = mode.value & ~(std::int64_t{3} << (2 * i));
  return {cleared | static_cast<std::int64_t>(slider) << (2 * i)};
}

/// All sliders stick; the other bits of the mode are unchanged.
inline Mode all_sticking(Mode mode) { return {mode.value & ~slider_bits::all}; }

inline Mode mirrored_sliders(Mode mode) {
  const std::int64_t forward = mode.value & slider_bits::forward, backward = mode.value & slider_bits::backward;
  return {(mode.value & ~slider_bits::all) | forward << 1 | backward >> 1};
}

/// Mode of `count` elements that all slip.
inline Mode all_slipping(int count, bool forward) {
  Mode mode;
  for (int i = 0; i < count; ++i) mode = with_slider(mode, i, forward ? Slider::slips_forward : Slider::slips_backward);
  return mode;
}

/// Common direction of all slipping elements, which are driven by the same motion: +1 or -1; 0 if none slips.
inline int slip_direction(Mode mode) {
  return (mode.value & slider_bits::forward) != 0 ? 1 : (mode.value & slider_bits::backward) != 0 ? -1 : 0;
}

/// Rule broken by two lists of properties of the elements, `key` and `other`: equal length, 1 to most_sliders.
template <class S>
std::optional<BrokenRule> validate_sliders(const std::string& key, const std::vector<S>& list,
                                           const std::string& other_key, const std::vector<S>& other) {
  if (list.empty()) return BrokenRule{key, "must have at least one element"};
  if (std::ssize(list) > most_sliders)
    return BrokenRule{
        key, "must have at most " + std::to_string(most_sliders) + " elements, has " + std::to_string(list.size())};
  if (other.size() != list.size())
    return BrokenRule{other_key, "must have as many entries as " + key + ": " + std::to_string(list.size()) + ", has " +
                                     std::to_string(other.size())};
  return std::nullopt;
}

/// Describing function of one element of stiffness k and limit W, h = W/k (claim A8):
///   N = (k/2)(1 - f(1 - 2h/A)) + j (4 W/(pi A))(1 - h/A),  k for A <= h.
/// With sin^2(psi/4) = h/A the real part is (k/2 pi)(psi - sin psi), which loses no digits where A >> h.
inline std::complex<double> stop_gain(double k, double W, double A) {
  const double h = W / k;
  if (A <= h) return k;
  const double psi = 4.0 * std::asin(std::sqrt(h / A));
  double rest = psi - std::sin(psi);
  if (psi < 1.0) {
    const double square = psi * psi;
    rest = 1.0;
    for (int order = 19; order >= 5; order -= 2) rest = 1.0 - square / ((order - 1) * order) * rest;
    rest *= psi * square / 6.0;
  }
  return {k * rest / (2.0 * std::numbers::pi), 4.0 * W / (std::numbers::pi * A) * ((A - h) / A)};
}

/// Parallel stop operators: element i is a spring k_i (N/m) that slips at W_i (N); its state is the stretch s_i (m) of
/// the spring, so that a long slide loses no digits. The law chooses the motion that drives the elements.
template <class S>
struct StopElements {
  std::vector<S> k, W;

  int states() const { return static_cast<int>(k.size()); }
  double state_scale(int i) const { return value_of(W[at(i)] / k[at(i)]); }

  S elastic_force(std::span<const S> s) const {
    S sum(0.0);
    for (std::size_t i = 0; i < k.size(); ++i) sum += k[i] * s[i];
    return sum;
  }
  /// Energy in the springs, sum k_i s_i^2/2.
  S storage(Mode, std::span<const S> s) const {
    S sum(0.0);
    for (std::size_t i = 0; i < k.size(); ++i) sum += 0.5 * k[i] * s[i] * s[i];
    return sum;
  }
  /// Rates of the stretches when all are driven at the rate `drive` (m/s).
  void stretch_rates(const S& drive, Mode mode, std::span<S> ds) const {
    for (int i = 0; i < states(); ++i) ds[at(i)] = slider(mode, i) == Slider::sticks ? drive : S(0.0);
  }

  /// Two guards an element: force left before it slips forwards and backwards (N).
  int limit_guards() const { return 2 * states(); }
  void guard_limits(Mode mode, std::span<const S> s, std::span<S> g) const {
    for (int i = 0; i < states(); ++i) {
      const S limit = W[at(i)] / k[at(i)];
      const bool sticks = slider(mode, i) == Slider::sticks;
      g[at(2 * i)] = sticks ? k[at(i)] * without_roundings(limit - s[at(i)], value_of(limit)) : W[at(i)];
      g[at(2 * i + 1)] = sticks ? k[at(i)] * without_roundings(limit + s[at(i)], value_of(limit)) : W[at(i)];
    }
  }
  /// Sets the element of limit guard `fired` exactly on its limit; it slips if driven outwards (it is not where a trial
  /// state lay beyond the limit).
  Mode slip(Mode mode, std::span<S> s, int fired, bool driven_forward) const {
    const std::size_t i = at(fired / 2);
    const bool forward = fired % 2 == 0;
    s[i] = (forward ? W[i] : -W[i]) / k[i];
    if (forward != driven_forward) return mode;
    return with_slider(mode, fired / 2, forward ? Slider::slips_forward : Slider::slips_backward);
  }

  std::optional<BrokenRule> validate_elements() const { return validate_sliders("k", k, "W", W); }
  std::vector<std::pair<double, double>> state_bounds() const {
    std::vector<std::pair<double, double>> bounds;
    bounds.reserve(k.size());
    for (int i = 0; i < states(); ++i) bounds.emplace_back(-state_scale(i), state_scale(i));
    return bounds;
  }
  double sum_of_limits() const {
    double sum = 0.0;
    for (const S& limit : W) sum += value_of(limit);
    return sum;
  }
  double smallest_yield() const {
    double smallest = infinite;
    for (int i = 0; i < states(); ++i) smallest = std::min(smallest, state_scale(i));
    return smallest;
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
};

}  // namespace limcycle
