#pragma once
#include <algorithm>

#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/levels.hpp"

namespace limcycle {

/// Coulomb friction behind a spring and damper, f = K e + B de/dt, f in g(v) Sgn(v - de/dt), in its continuous form:
///   f = sat(g(v); K e + B v),   de/dt = (f - K e)/B,   F = f + sigma2 v.
/// The level g is taken at the velocity v, which leaves the equations explicit; the variant with g at the slip rate
/// v - de/dt is a different law where g falls (its f is then not unique for B < max(-dg/dv)). The cap +g is that of
/// forward slip. One state (e, m); local memory; no drift; |f| <= Fs; passive with storage K e^2/2: at the cap
/// f (v - de/dt) = g |v - de/dt| >= 0. Time constant B/K. Kikuuwe, Takesue, Sano, Mochiyama, Fujimoto (2005).
///
/// Modes: 0 stick (de/dt = v), +1 and -1 at the cap of that sign. The force is continuous over a switch.
template <class S>
struct Kikuuwe : StribeckCurve<S> {
  S K{}, B{}, sigma2{0.0};

  static constexpr std::string_view kind = "kikuuwe";
  static constexpr bool is_one_state = true;
  static constexpr std::string_view equation =
      "F = sat(g(v); K e + B v) + sigma2 v;  de/dt = (sat(g(v); K e + B v) - K e)/B;  g = Fc + (Fs - Fc) "
      "exp(-|v/vs|^delta)";
  static constexpr std::string_view source =
      "Kikuuwe, Takesue, Sano, Mochiyama, Fujimoto (2005), IROS; continuous form after Xiong, Kikuuwe, Yamamoto "
      "(2013), "
      "J. Appl. Math. 320276";
  static constexpr Features features{
      .memory = Memory::local,
      .drifts = false,
      .drift = "none: no slip while |K e + B v| < g(v)",
      .rate = "B before sliding, g(v) in sliding, time constant B/K",
      .passivity = "passive for all K, B > 0 and g > 0, storage K e^2/2",
      .evidence =
          "the continuous form derived from the stated idea; published equations not confirmed, nor whether g "
          "is taken at v (as here) or at the slip rate"};

  static std::vector<Parameter<Kikuuwe, S>> parameters() {
    auto table = StribeckCurve<S>::template stribeck_table<Kikuuwe>();
    table.push_back({"K", "N/m", "stiffness", &Kikuuwe::K, positive});
    table.push_back({"B", "N s/m", "damping", &Kikuuwe::B, positive});
    table.push_back({"sigma2", "N s/m", "viscous friction", &Kikuuwe::sigma2, not_negative, false});
    return table;
  }
  std::optional<BrokenRule> validate() const { return this->validate_levels(); }

  int states() const { return 1; }
  void rate(const Input<S>& in, Mode mode, std::span<const S> e, std::span<S> de) const {
    de[0] = mode.value == 0 ? in.v : (cap(in, mode.value > 0) - K * e[0]) / B;
  }
  S output(const Input<S>& in, Mode mode, std::span<const S> e) const {
    return (mode.value == 0 ? trial(in, e[0]) : cap(in, mode.value > 0)) + sigma2 * in.v;
  }

  S storage(Mode, std::span<const S> e) const { return 0.5 * K * e[0] * e[0]; }

  int guards(Mode mode) const { return mode.value == 0 ? 2 : 1; }
  /// The modes overlap by a few roundings of the force, so that a force within rounding of the cap switches once.
  void guard(const Input<S>& in, Mode mode, std::span<const S> e, std::span<S> g) const {
    const S force = trial(in, e[0]);
    if (mode.value == 0) {
      g[0] = cap(in, true) * S(1.0 + 1e-14) - force;
      g[1] = force - cap(in, false) * S(1.0 + 1e-14);
    } else {
      g[0] = mode.value > 0 ? force - cap(in, true) : cap(in, false) - force;
    }
  }
  Mode next(const Input<S>&, Mode mode, std::span<S>, int fired) const {
    return {mode.value != 0 ? 0 : fired == 0 ? 1 : -1};
  }
  Mode start(const Input<double>& in, std::span<double> e) const {
    const Input<S> at{S(in.x), S(in.v), S(in.drive)};
    const S force = trial(at, S(e[0]));
    return {force > cap(at, true) ? 1 : force < cap(at, false) ? -1 : 0};
  }

  static bool is_passive() { return true; }
  bool odd() const { return this->symmetric(); }
  Mode mirror(Mode mode) const { return {-mode.value}; }
  Scales scales() const {
    return {.displacement = value_of(this->Fs / K),
            .velocity = std::min(value_of(this->vs), value_of(this->Fs / B)),
            .output = value_of(this->Fs)};
  }
  double state_scale(int) const { return value_of(this->Fs / K); }

 private:
  S trial(const Input<S>& in, const S& e) const { return K * e + B * in.v; }
  /// Largest force in forward slip, or least in backward slip.
  S cap(const Input<S>& in, bool forward) const {
    using std::abs;
    const S g = this->level(abs(in.v), forward);
    return forward ? g : -g;
  }
};

}  // namespace limcycle
