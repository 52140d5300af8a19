#pragma once
#include <cmath>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Integrator that is reset where its input, an error, stops on the other side of the set-point: dz/dt = gain x, y = z,
/// and z becomes (1 - share) z where |dx/dt| falls to `speed` while gain x z < 0: the integral pushes away from the
/// set-point. share = 1: it begins anew; 2: it pushes back with the same force. A body that stops
/// before the set-point, towards which the integral pushes it, resets nothing.
///
/// Modes: +-1 while dx/dt is beyond +-speed, 0 between. State: z.
template <class S>
struct StopResetIntegrator {
  S gain{}, share{1.0}, speed{};

  static constexpr std::string_view kind = "stop-reset-integrator";
  static constexpr bool piecewise_affine = true;
  static constexpr bool uses_rate = true;
  static constexpr std::string_view equation =
      "dz/dt = gain x, y = z; z becomes (1 - share) z where |dx/dt| falls to speed while gain x z < 0";
  static constexpr std::string_view source =
      "after Beerens et al. (2021), doi 10.1109/TCST.2021.3063420, whose controller resets where the velocity "
      "vanishes; "
      "the speed is that of a sensor which cannot see it vanish";

  static std::vector<Parameter<StopResetIntegrator, S>> parameters() {
    return {{"gain", "1/s", "integral gain", &StopResetIntegrator::gain, any_number},
            {"share", "1", "of the integral, taken off at a reset", &StopResetIntegrator::share, {0.0, 2.0}, false},
            {"speed", "1/s", "|dx/dt| below which the body counts as stopped", &StopResetIntegrator::speed, positive}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  int states() const { return 1; }
  void rate(const Input<S>& in, Mode, std::span<const S>, std::span<S> dz) const { dz[0] = gain * in.x; }
  S output(const Input<S>&, Mode, std::span<const S> z) const { return z[0]; }

  int guards(Mode mode) const { return mode.value == 0 ? 2 : 1; }
  void guard(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> g) const {
    if (mode.value != 0) {
      g[0] = S(mode.value > 0 ? 1.0 : -1.0) * in.v - speed;
    } else {
      g[0] = speed - in.v;
      g[1] = speed + in.v;
    }
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S> z, int fired) const {
    if (mode.value == 0) return {fired == 0 ? 1 : -1};
    if (value_of(gain) * value_of(in.x) * value_of(z[0]) < 0.0) z[0] = (S(1.0) - share) * z[0];
    return {0};
  }
  Mode start(const Input<double>& in, std::span<double> z) const {
    z[0] = 0.0;
    return std::abs(in.v) > value_of(speed) ? Mode{in.v > 0.0 ? 1 : -1} : Mode{0};
  }

  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return {-mode.value}; }
  bool even_state(int) const { return false; }

  Scales scales() const { return {}; }
  double state_scale(int) const { return 1.0; }
};

}  // namespace limcycle
