#pragma once
#include <cmath>
#include <complex>

#include "limcycle/models/element/concepts.hpp"
#include "limcycle/models/element/of_controllers/clamped_pi_gain.hpp"

namespace limcycle {

/// PI controller with a limit, whose integral is clamped (conditional integration): u = kp x + z, y = u limited to
/// +-limit, dz/dt = ki x, but 0 while u is beyond the limit and ki x has its sign. With kp = 0: an integrator that
/// stops at +-limit. Where u would leave the limit while z stands still, and come back at once when it moves, it stays
/// there (Filippov): z then follows, z = +-limit - kp x. Astrom and Hagglund (1995), PID Controllers, ch. 3.5.
///
/// Modes, of the sign of u: 0 within the limit, +-1 beyond it and coming back, +-2 beyond it and clamped, +-3 on it.
template <class S>
struct ClampedPi {
  S kp{0.0}, ki{}, limit{};

  static constexpr std::string_view kind = "clamped-pi";
  static constexpr bool piecewise_affine = true;
  static constexpr bool uses_rate = true;
  static constexpr std::string_view equation =
      "u = kp x + z, y = u limited to +-limit; dz/dt = ki x, 0 while u is beyond the limit and ki x has its sign";
  static constexpr std::string_view source = "Astrom and Hagglund (1995), PID Controllers, ch. 3.5";

  static std::vector<Parameter<ClampedPi, S>> parameters() {
    return {{"ki", "1/s", "integral gain", &ClampedPi::ki, any_number},
            {"limit", "1", "largest output", &ClampedPi::limit, positive},
            {"kp", "1", "proportional gain", &ClampedPi::kp, any_number, false}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  int states() const { return 1; }
  void rate(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> dz) const {
    dz[0] = std::abs(mode.value) <= 1 ? ki * in.x : S(0.0);
  }
  S output(const Input<S>& in, Mode mode, std::span<const S> z) const {
    return mode.value == 0 ? kp * in.x + z[0] : side(mode) * limit;
  }

  int guards(Mode) const { return 2; }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
    const S s = side(mode), u = kp * in.x + z[0];
    switch (std::abs(mode.value)) {
      case 0:
        g[0] = limit - u;
        g[1] = limit + u;
        break;
      case 1:
        g[0] = s * u - limit;
        g[1] = -s * ki * in.x;
        break;
      case 2:
        g[0] = s * u - limit;
        g[1] = s * ki * in.x;
        break;
      default:
        g[0] = s * (kp * in.v + ki * in.x);
        g[1] = -s * kp * in.v;
    }
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S> z, int fired) const {
    if (mode.value == 0) return at_limit(fired == 0 ? 1 : -1, in);
    const std::int64_t s = mode.value > 0 ? 1 : -1;
    switch (std::abs(mode.value)) {
      case 1:
        return {fired == 0 ? 0 : 2 * s};
      case 2:
        return fired == 0 ? at_limit(s, in) : Mode{s};
      default:
        z[0] = side(mode) * limit - kp * in.x;
        return {fired == 0 ? 0 : 2 * s};
    }
  }
  Mode start(const Input<double>& in, std::span<double> z) const {
    z[0] = 0.0;
    const double u = value_of(kp) * in.x;
    if (std::abs(u) <= value_of(limit)) return {0};
    const std::int64_t s = u > 0.0 ? 1 : -1;
    return {u * value_of(ki) * in.x > 0.0 ? 2 * s : s};
  }

  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return {-mode.value}; }
  /// See clamped_pi_gain(). Empty with a bias, under which the integral is marched.
  std::optional<std::complex<double>> exact_describing_function(double A, double w,
                                                                double bias) const requires std::same_as<S, double> {
    if (bias != 0.0) return std::nullopt;
    return clamped_pi_gain(kp, ki, limit, A, w);
  }

  std::pair<double, double> working_gain() const { return {value_of(kp), 0.0}; }
  Scales scales() const { return {.output = value_of(limit)}; }
  double state_scale(int) const { return value_of(limit); }

 private:
  static S side(Mode mode) { return S(mode.value > 0 ? 1.0 : -1.0); }
  /// What follows when u comes to the limit on side s, from within or from beyond.
  Mode at_limit(std::int64_t s, const Input<S>& in) const {
    const double sign = static_cast<double>(s), clamped = sign * value_of(kp * in.v),
                 free = clamped + sign * value_of(ki * in.x);
    if (free <= 0.0) return {clamped > 0.0 ? s : 0};
    return {clamped > 0.0 ? 2 * s : 3 * s};
  }
};

}  // namespace limcycle
