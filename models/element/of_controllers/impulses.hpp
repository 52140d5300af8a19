#pragma once
#include <cmath>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Impulsive compensation of friction: where the input x, an error, stays beyond the band and its rate says that the
/// body has stopped, y = force sgn(x) for the time `width`, and the next one begins at the earliest `pause` after that;
/// else y = 0. The body hops towards the set-point until it stops within the band. The sign is that of x when the
/// impulse begins.
///
/// Modes: 0 waits with |dx/dt| <= speed and |x| <= band; +-1 waits while dx/dt is beyond +-speed; +-2 impulse of that
/// sign; 3 pause behind an impulse. State: time that is left of the impulse or the pause, s.
template <class S>
struct Impulses {
  S force{}, width{}, pause{}, band{}, speed{};

  static constexpr std::string_view kind = "impulses";
  static constexpr bool piecewise_affine = true;
  static constexpr bool uses_rate = true;
  static constexpr std::string_view equation =
      "y = force sgn(x) for width, again after a pause, where |dx/dt| <= speed and |x| > band; else 0";
  static constexpr std::string_view source =
      "Yang, Tomizuka (1988), Adaptive pulse width control for precise positioning under the influence of stiction and "
      "Coulomb friction, J. Dyn. Syst. Meas. Control 110; Armstrong-Helouvry, Dupont, Canudas de Wit (1994), "
      "Automatica 30, section 4.2; both quoted from knowledge, with impulses of one size";

  static std::vector<Parameter<Impulses, S>> parameters() {
    return {{"force", "N", "size of an impulse", &Impulses::force, not_negative},
            {"width", "s", "duration of an impulse", &Impulses::width, positive},
            {"pause", "s", "least time between two impulses", &Impulses::pause, positive},
            {"band", "1", "largest |x| without impulses", &Impulses::band, positive},
            {"speed", "1/s", "|dx/dt| below which the body counts as stopped", &Impulses::speed, positive}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  int states() const { return 1; }
  void rate(const Input<S>&, Mode mode, std::span<const S>, std::span<S> dz) const {
    dz[0] = S(is_timed(mode) ? -1.0 : 0.0);
  }
  S output(const Input<S>&, Mode mode, std::span<const S>) const {
    return std::abs(mode.value) == 2 ? S(mode.value > 0 ? 1.0 : -1.0) * force : S(0.0);
  }

  int guards(Mode mode) const { return mode.value == 0 ? 4 : 1; }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
    if (is_timed(mode)) {
      g[0] = z[0];
    } else if (mode.value != 0) {
      g[0] = S(mode.value > 0 ? 1.0 : -1.0) * in.v - speed;
    } else {
      g[0] = speed - in.v;
      g[1] = speed + in.v;
      g[2] = band - in.x;
      g[3] = band + in.x;
    }
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S> z, int fired) const {
    if (std::abs(mode.value) == 2) {
      z[0] = pause;
      return {3};
    }
    z[0] = S(0.0);
    if (mode.value == 0) return fired < 2 ? Mode{fired == 0 ? 1 : -1} : impulse(fired == 2 ? 1 : -1, z);
    if (mode.value == 3 && std::abs(value_of(in.v)) > value_of(speed)) return {in.v > S(0.0) ? 1 : -1};
    return std::abs(value_of(in.x)) > value_of(band) ? impulse(in.x > S(0.0) ? 1 : -1, z) : Mode{0};
  }
  /// Without an impulse: one that is due begins at once, by a guard that is negative.
  Mode start(const Input<double>& in, std::span<double> z) const {
    z[0] = 0.0;
    return std::abs(in.v) > value_of(speed) ? Mode{in.v > 0.0 ? 1 : -1} : Mode{0};
  }

  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return {mode.value == 3 ? 3 : -mode.value}; }
  bool even_state(int) const { return true; }

  Scales scales() const { return {.output = value_of(force)}; }
  double state_scale(int) const { return value_of(pause); }

 private:
  Mode impulse(std::int64_t sign, std::span<S> z) const {
    z[0] = width;
    return {2 * sign};
  }
  static bool is_timed(Mode mode) { return std::abs(mode.value) >= 2; }
};

}  // namespace limcycle
