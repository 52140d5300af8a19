#pragma once
#include <cmath>
#include <complex>
#include <numbers>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Integrator that is reset where its input changes sign: dz/dt = gain x, y = z, and z becomes (1 - share) z at each
/// zero crossing of x, at the earliest `interval` after the last reset; a crossing before that passes without one.
/// share = 0: a linear integrator; 1: that of Clegg (1958); 2: its output changes sign. An input that touches zero and
/// returns, or stays there, does not reset it.
///
/// Modes, of the sign of x: +-1 ready, +-2 waiting for the interval to pass. States: z; with an interval also the time
/// that is left of it.
template <class S>
struct ResetIntegrator {
  S gain{}, share{1.0}, interval{0.0};

  static constexpr std::string_view kind = "reset-integrator";
  static constexpr bool piecewise_affine = true;
  static constexpr std::string_view equation =
      "dz/dt = gain x, y = z; z becomes (1 - share) z where x changes sign, at the earliest interval after the last "
      "reset";
  static constexpr std::string_view source =
      "Clegg (1958), A nonlinear integrator for servomechanisms, Trans. AIEE II 77; against hunting: Beerens et al. "
      "(2021), doi 10.1109/TCST.2021.3063420";

  static std::vector<Parameter<ResetIntegrator, S>> parameters() {
    return {{"gain", "1/s", "integral gain", &ResetIntegrator::gain, any_number},
            {"share", "1", "of the integral, taken off at a reset", &ResetIntegrator::share, {0.0, 2.0}, false},
            {"interval", "s", "least time between two resets", &ResetIntegrator::interval, not_negative, false}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  int states() const { return waits() ? 2 : 1; }
  void rate(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> dz) const {
    dz[0] = gain * in.x;
    if (waits()) dz[1] = S(is_ready(mode) ? 0.0 : -1.0);
  }
  S output(const Input<S>&, Mode, std::span<const S> z) const { return z[0]; }

  int guards(Mode mode) const { return is_ready(mode) ? 1 : 2; }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
    g[0] = S(mode.value > 0 ? 1.0 : -1.0) * in.x;
    if (!is_ready(mode)) g[1] = z[1];
  }
  Mode next(const Input<S>&, Mode mode, std::span<S> z, int fired) const {
    const std::int64_t sign = mode.value > 0 ? 1 : -1;
    if (fired == 1) {
      z[1] = S(0.0);
      return {sign};
    }
    if (!is_ready(mode)) return {-mode.value};
    z[0] = (S(1.0) - share) * z[0];
    if (waits()) z[1] = interval;
    return {waits() ? -2 * sign : -sign};
  }
  Mode start(const Input<double>& in, std::span<double> z) const {
    z[0] = 0.0;
    if (waits()) z[1] = 0.0;
    return {in.x < 0.0 ? -1 : 1};
  }

  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return {-mode.value}; }
  bool even_state(int i) const { return i == 1; }

  /// gain/w (4/pi share/(2 - share) - j), reset at every zero of A sin wt: from one zero to the next z rises by
  /// 2 gain A/w, from -(1 - share)/(2 - share) of that. Empty with a bias, if the interval is longer than half a
  /// period, and for share = 2, where z grows without limit.
  std::optional<std::complex<double>> exact_describing_function(double, double w,
                                                                double bias) const requires std::same_as<S, double> {
    if (bias != 0.0 || interval * w > std::numbers::pi || share >= 2.0) return std::nullopt;
    return gain / w * std::complex<double>(4.0 / std::numbers::pi * share / (2.0 - share), -1.0);
  }

  Scales scales() const { return {}; }
  double state_scale(int i) const { return i == 0 ? 1.0 : value_of(interval); }

 private:
  bool waits() const { return value_of(interval) > 0.0; }
  static bool is_ready(Mode mode) { return std::abs(mode.value) == 1; }
};

}  // namespace limcycle
