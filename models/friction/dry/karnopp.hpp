#pragma once
#include <algorithm>

#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/levels.hpp"

namespace limcycle {

/// Karnopp's friction: a body slower than dv counts as being at rest. When its speed falls to dv it is stopped (by an
/// impulse of the friction, at most dv times the mass that it moves), and rests as long as the applied force, the
/// drive, stays within +-Fs. It then breaks away against Fs, which acts until |v| has left the band again (or the body
/// has returned to v = 0); outside F = g(v) sgn v. The viscous part is added at every speed. No state, no drift.
///
/// Karnopp's program keeps the small momentum of a resting body and sets only its velocity to zero; here the momentum
/// is removed too, so that rest is one state. Within the band the law needs the applied force: under prescribed motion
/// it is undefined there. Modes: 0 rest; +1, -1 outside the band; +2, -2 breaking away within it.
/// Karnopp (1985), ASME J. Dyn. Sys. Meas. Control 107(1), 100-103.
template <class S>
struct Karnopp : StribeckCurve<S>, Memoryless<S> {
  S dv{}, sigma2{0.0};

  static constexpr Mode stuck{0}, forward{1}, backward{-1}, leaving_forward{2}, leaving_backward{-2};
  static constexpr bool output_needs_rate = true;
  static constexpr Held holds = Held::rate;
  static constexpr std::string_view kind = "karnopp";
  static constexpr std::string_view equation =
      "|v| >= dv: F = g(v) sgn(v) + sigma2 v;  |v| < dv: the body is stopped and F balances the applied force up to "
      "Fs, "
      "F = Fs sgn(v) + sigma2 v while it breaks away;  g = Fc + (Fs - Fc) exp(-|v/vs|^delta)";
  static constexpr std::string_view source = "Karnopp (1985), ASME J. Dyn. Sys. Meas. Control 107(1), 100-103";
  static constexpr Features features{
      .memory = Memory::none,
      .drifts = false,
      .drift = "none: a body in the band is stopped, and rests while the applied force stays below Fs",
      .rate = "the Stribeck curve, and sigma2 v",
      .passivity = "yes, for sigma2 >= 0: g > 0, and stopping the body takes energy out of it",
      .evidence =
          "the dead band in velocity and the saturation at Fs are described in public code; the equations of the paper "
          "were not confirmed. Stopping the body on entering the band, and Fs until it has left it, are our reading of "
          "\"v is set to 0\""};

  static std::vector<Parameter<Karnopp, S>> parameters() {
    auto table = StribeckCurve<S>::template stribeck_table<Karnopp>();
    table.push_back({"dv", "m/s", "half-width of the zero-velocity band", &Karnopp::dv, positive});
    table.push_back({"sigma2", "N s/m", "viscous friction", &Karnopp::sigma2, not_negative, false});
    return table;
  }
  std::optional<BrokenRule> validate() const { return this->validate_levels(); }

  S output(const Input<S>& in, Mode mode, std::span<const S>) const {
    if (mode == stuck) return in.drive;
    using std::abs;
    const S viscous = sigma2 * in.v;
    if (mode == forward || mode == backward) {
      const S g = this->level(abs(in.v), mode == forward);
      return (mode == forward ? g : -g) + viscous;
    }
    return (mode == leaving_forward ? this->Fs : -this->Fs_minus) + viscous;
  }

  Held held(Mode mode) const { return mode == stuck ? Held::rate : Held::nothing; }
  /// True on entering the band from outside.
  bool arrests(Mode mode, int) const { return mode == forward || mode == backward; }
  double drive_band() const { return value_of(dv); }
  /// Element of Sgn(v) that an output stands for: the sign of v while moving, F/Fs at rest.
  S selection(Mode mode, const S& output) const {
    if (mode != stuck) return S(mode.value > 0 ? 1.0 : -1.0);
    return output / select(output < 0.0, this->Fs_minus, this->Fs);
  }

  int guards(Mode mode) const { return mode == forward || mode == backward ? 1 : 2; }
  void guard(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> g) const {
    const S speed = mode.value > 0 ? in.v : -in.v;
    if (mode == stuck) {
      g[0] = this->Fs - in.drive;
      g[1] = in.drive + this->Fs_minus;
    } else if (mode == forward || mode == backward) {
      g[0] = speed - dv;
    } else {
      g[0] = dv - speed;
      g[1] = speed;
    }
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S>, int fired) const {
    if (mode == stuck) return fired == 0 ? leaving_forward : leaving_backward;
    if (mode == leaving_forward && fired == 0) return forward;
    if (mode == leaving_backward && fired == 0) return backward;
    return at_rest(value_of(in.drive));
  }
  Mode start(const Input<double>& in, std::span<double>) const {
    const double band = value_of(dv);
    if (in.v == 0.0) return at_rest(in.drive);
    if (in.v > 0.0) return in.v >= band ? forward : leaving_forward;
    return in.v <= -band ? backward : leaving_backward;
  }

  /// |F - sigma2 v| <= Fs.
  std::optional<double> force_bound(double speed) const { return this->bound_with_viscous(sigma2, speed); }
  bool odd() const { return this->symmetric(); }
  Scales scales() const {
    return {.velocity = std::min(value_of(this->vs), value_of(dv)), .output = value_of(this->Fs)};
  }

 private:
  Mode at_rest(double drive) const {
    return drive > value_of(this->Fs) ? leaving_forward : drive < -value_of(this->Fs_minus) ? leaving_backward : stuck;
  }
};

}  // namespace limcycle
