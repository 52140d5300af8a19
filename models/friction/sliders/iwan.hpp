#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/models/friction/branch_curves.hpp"
#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/masing_gain.hpp"
#include "limcycle/models/friction/return_points.hpp"
#include "limcycle/models/friction/stop_elements.hpp"

namespace limcycle {

/// Iwan friction: the hysteresis of infinitely many (elements = 0) or `elements` Jenkins elements in parallel, from its
/// virgin curve and Masing's rule, f = f_r + d 2 f_v(|x - x_r|/2) after a reversal. Virgin curves, u = z/Zb:
///   exponential Fs (1 - e^-u);  hyperbolic Fs u/(1 + u);  koizumi-shibazaki Fs u (1 - ln u), Fs from u = 1;
///   linear Fs u, Fs from u = 1.
/// The exponential curve counts as saturated at u = 40, where e^-u is below rounding; the hyperbolic one never is.
///
/// With elements = N the curve is that of N elements of equal yield force Fs/N, whose yield displacements y_i are the
/// (i - 1/2)/N quantiles of the yield force f_v - z f_v' (koizumi-shibazaki: y_i = (i - 1/2) Zb/N): f_v = sum of
/// (Fs/N) min(z/y_i, 1). Up to `most_kinks` elements each yield is a located event; with more elements the kinks, of
/// 1/N each, lie within the panels and steps of the methods. Cost of a force: one curve, or N terms, a return point.
///
/// The slope of the koizumi-shibazaki curve is infinite at every reversal; derivatives with respect to parameters and
/// states keep it below 42.4 Fs/Zb there. States and modes: ReturnPoints (at most 12 return points); in the bits above,
/// the mode counts the elements that have yielded on the present branch.
/// Iwan (1966, 1967), Masing (1926).
template <class S>
struct Iwan {
  S Fs{}, Zb{}, elements{0.0};
  Choice curve{};
  static constexpr std::string_view curves[] = {"exponential", "hyperbolic", "koizumi-shibazaki", "linear"};

  static constexpr double most_elements = 1e5;
  static constexpr int most_kinks = 100;
  static constexpr std::string_view kind = "iwan";
  static constexpr bool keeps_return_points = true;
  static constexpr bool rate_independent = true;
  static constexpr std::string_view equation =
      "F = f_r + d 2 f_v(|x - x_r|/2) since the last reversal (x_r, f_r), d = sgn(v), loops that close being "
      "forgotten; "
      "f_v = Fs (1 - exp(-u)) | Fs u/(1 + u) | Fs u (1 - ln u) up to u = 1 | Fs u up to u = 1, u = z/Zb";
  static constexpr std::string_view source =
      "Iwan (1966), J. Appl. Mech. 33, 893-900, and 34 (1967); Masing (1926); not confirmed";
  static constexpr Features features{
      .memory = Memory::non_local,
      .drifts = false,
      .drift = "none: a closed cycle of force below Fs is a closed path",
      .rate = "none: the force is a function of the path alone",
      .passivity = "yes: storage is the energy in the springs of the elements",
      .evidence =
          "the papers are quoted from knowledge, not confirmed; the describing functions were derived and checked "
          "numerically, that of koizumi-shibazaki also against 4000 elements"};

  static std::vector<Parameter<Iwan, S>> parameters() {
    return {
        {"curve", "1", "virgin curve", &Iwan::curve, any_number, false, "", curves},
        {"Fs", "N", "force of sliding", &Iwan::Fs, positive},
        {"Zb", "m", "displacement over which the virgin curve rises", &Iwan::Zb, positive},
        {"elements", "1", "number of elements; 0: infinitely many", &Iwan::elements, Range{0.0, most_elements}, false}};
  }
  std::optional<BrokenRule> validate() const {
    const double number = value_of(elements);
    if (number != std::floor(number))
      return BrokenRule{"elements", "must be a whole number, got " + std::to_string(number)};
    return std::nullopt;
  }

  int states() const { return Stack::states; }
  void rate(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> dz) const {
    const ReturnMode at = ReturnMode::of(mode);
    for (int i = 0; i < Stack::states; ++i) dz[static_cast<std::size_t>(i)] = S(0.0);
    if (!at.saturated) dz[0] = static_cast<double>(at.direction) * in.v;
  }
  S output(const Input<S>&, Mode mode, std::span<const S> z) const {
    const Virgin shape(*this);
    return Stack{shape}.force(ReturnMode::of(mode), z);
  }

  /// Energy in the springs of the elements.
  S storage(Mode mode, std::span<const S> z) const {
    const Virgin shape(*this);
    return Stack{shape}.energy(ReturnMode::of(mode), z);
  }

  /// The velocity along the branch; the path left to its end; the path left to the next element that yields.
  int guards(Mode) const { return kinks() > 0 ? 3 : 2; }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
    const ReturnMode at = ReturnMode::of(mode);
    const Virgin shape(*this);
    g[0] = static_cast<double>(at.direction) * in.v;
    g[1] = Stack{shape}.way_left(at, z);
    if (kinks() == 0) return;
    const int yielded = static_cast<int>(mode.value >> ReturnMode::bits);
    g[2] = at.saturated || yielded >= kinks() ? S(infinite) : kink(yielded, at) - z[0];
  }
  Mode next(const Input<S>&, Mode mode, std::span<S> z, int fired) const {
    if (fired == 2) return {mode.value + (std::int64_t{1} << ReturnMode::bits)};
    const ReturnMode at = ReturnMode::of(mode);
    const Virgin shape(*this);
    const Stack stack{shape};
    const ReturnMode after = fired == 0 ? stack.reverse(at, z) : stack.arrive(at, z);
    std::int64_t yielded = 0;
    while (!after.saturated && yielded < kinks() && z[0] >= kink(static_cast<int>(yielded), after)) ++yielded;
    return after.in({yielded << ReturnMode::bits});
  }
  Mode start(const Input<double>& in, std::span<double> z) const { return Stack::start(in, z).in({}); }

  static bool is_passive() { return true; }
  std::optional<double> force_bound(double) const { return value_of(Fs); }
  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return Stack::mirror(mode); }
  bool even_state(int) const { return true; }
  static bool unused(Mode mode, int i) { return Stack::unused(mode, i); }
  Scales scales() const { return {.displacement = shortest(), .output = value_of(Fs)}; }
  double state_scale(int i) const { return Stack::state_scale(i, value_of(Zb), value_of(Fs)); }

  /// Force of the virgin curve at z >= 0, N.
  S virgin(const S& z) const { return Virgin(*this).virgin(z, 1.0); }

  /// Claims A11 and, for a finite number of elements, A9; no closed form for a mean velocity.
  std::optional<std::complex<double>> exact_describing_function(double A, double,
                                                                double bias) const requires std::same_as<S, double> {
    if (bias != 0.0) return std::nullopt;
    if (curve.index == 3) return stop_gain(Fs / Zb, Fs, A);
    if (elements > 0.0) {
      std::complex<double> sum = 0.0;
      const double W = Fs / elements;
      for (int i = 0; i < static_cast<int>(elements); ++i) sum += stop_gain(W / yield(i), W, A);
      return sum;
    }
    return curve.index == 0   ? exponential_masing_gain(Fs, Zb, A)
           : curve.index == 1 ? hyperbolic_masing_gain(Fs, Zb, A)
                              : koizumi_shibazaki_masing_gain(Fs, Zb, A);
  }

 private:
  /// The virgin curve as a shape for ReturnPoints.
  struct Virgin {
    static constexpr bool masing = true;
    const Iwan& law;
    S end;

    explicit Virgin(const Iwan& iwan) : law(iwan), end(iwan.saturation()) {}
    const S& level(double) const { return law.Fs; }
    S virgin(const S& z, double) const {
      using std::abs;
      using std::exp;
      const S u = abs(z) / law.Zb;
      if (law.elements > 0.0 && law.curve.index != 3) return sign(z) * law.of_elements(u);
      switch (law.curve.index) {
        case 0:
          return sign(z) * law.Fs * (1.0 - exp(-u));
        case 1:
          return sign(z) * law.Fs * u / (1.0 + u);
        case 2:
          return sign(z) * law.Fs * koizumi_shibazaki_curve(u);
        default:
          return law.Fs * z / law.Zb;
      }
    }
    S virgin_energy(const S& z) const {
      using std::exp;
      using std::log;
      const S u = z / law.Zb;
      if (law.elements > 0.0 && law.curve.index != 3) return law.energy_of_elements(u);
      switch (law.curve.index) {
        case 0:
          return law.Fs * law.Zb * (1.0 - exp(-u) - u * exp(-u));
        case 1:
          return law.Fs * law.Zb * (log(1.0 + u) - u / (1.0 + u));
        case 2:
          return law.Fs * law.Zb * koizumi_shibazaki_energy(u);
        default:
          return 0.5 * law.Fs * law.Zb * u * u;
      }
    }
  };
  using Stack = ReturnPoints<S, Virgin>;
  friend struct Virgin;

  int kinks() const {
    const double count = value_of(elements);
    return count > most_kinks || curve.index == 3 ? 0 : static_cast<int>(count);
  }
  /// Path along the present branch at which element i yields.
  S kink(int i, ReturnMode at) const { return (at.depth == 0 ? 1.0 : 2.0) * (1.0 - 1e-12) * quantile(i) * Zb; }

  S saturation() const {
    const int count = static_cast<int>(value_of(elements));
    if (curve.index == 3) return Zb;
    if (count > 0) return quantile(count - 1) * Zb;
    return curve.index == 0 ? 40.0 * Zb : curve.index == 1 ? S(infinite) : Zb;
  }

  S of_elements(const S& u) const {
    const int count = static_cast<int>(value_of(elements));
    S sum(0.0);
    for (int i = 0; i < count; ++i) {
      const double y = quantile(i);
      sum = sum + select(u < y, u / y, S(1.0));
    }
    return Fs / static_cast<double>(count) * sum;
  }

  S energy_of_elements(const S& u) const {
    const int count = static_cast<int>(value_of(elements));
    S sum(0.0);
    for (int i = 0; i < count; ++i) {
      const double y = quantile(i);
      sum = sum + select(u < y, u * u / (2.0 * y), S(0.5 * y));
    }
    return Fs * Zb / static_cast<double>(count) * sum;
  }

  /// Yield displacement of element i, counted from 0, in units of Zb: the elements that have yielded there carry
  /// (i + 1/2)/N of Fs.
  double quantile(int i) const {
    const double share = (i + 0.5) / value_of(elements), root = std::sqrt(share);
    if (curve.index == 1) return root / (1.0 - root);  // (u/(1 + u))^2 = share
    if (curve.index == 2) return share;                // u = share
    // 1 - (1 + u) e^-u = share, by Newton's method from an estimate that is close for small shares.
    double u = std::sqrt(2.0 * share) + share;
    for (int k = 0; k < 60; ++k) {
      const double excess = -std::expm1(-u) - u * std::exp(-u) - share, step = excess / (u * std::exp(-u));
      u -= std::max(-1.0, std::min(step, 0.5 * u));
      if (std::abs(step) <= 1e-15 * u) break;
    }
    return u;
  }
  double yield(int i) const { return quantile(i) * value_of(Zb); }
  double shortest() const {
    return elements > 0.0 && curve.index != 3 ? std::min(yield(0), value_of(Zb)) : value_of(Zb);
  }
};

}  // namespace limcycle
