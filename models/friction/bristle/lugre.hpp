#pragma once
#include <algorithm>

#include "limcycle/models/element/linear_state.hpp"
#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/levels.hpp"

namespace limcycle {

/// LuGre friction (Canudas de Wit, Olsson, Astrom, Lischinsky 1995, IEEE TAC 40(3), 419-425):
///   dz/dt = v - sigma0 |v| z / g(v),   F = sigma0 z + sigma1(v) dz/dt + sigma2 v,
/// with sigma1(v) = sigma1 exp(-(v/vd)^2) when vd > 0 (Olsson 1996, not confirmed), else constant.
/// One state (bristle deflection z, m), linear in that state; rate-dependent; local memory; drifts; |z| <= Fs/sigma0 is
/// invariant. Passive from v to F only if sigma2/sigma1 >= (Fs - Fc)/Fc (Barabanov and Ortega 2000), for constant
/// sigma1.
template <class S>
struct LuGre : StribeckCurve<S> {
  S sigma0{}, sigma1{0.0}, sigma2{0.0}, vd{0.0};

  static constexpr std::string_view kind = "lugre";
  static constexpr bool is_one_state = true;
  static constexpr bool output_needs_rate = true;
  static constexpr std::string_view equation =
      "dz/dt = v - sigma0 |v| z/g(v);  F = sigma0 z + sigma1 exp(-(v/vd)^2) dz/dt + sigma2 v (vd = 0: sigma1 "
      "constant);  "
      "g = Fc + (Fs - Fc) exp(-|v/vs|^delta)";
  static constexpr std::string_view source =
      "Canudas de Wit, Olsson, Astrom, Lischinsky (1995), IEEE TAC 40(3), 419-425";
  static constexpr Features features{
      .memory = Memory::local,
      .drifts = true,
      .drift = "ratchets under a biased periodic force of any size; slowly as dahl with exponent 1 and the level Fs",
      .rate =
          "sigma1 in pre-sliding, g(v) and sigma2 v in sliding; the level is followed with a lag over the distance "
          "g/sigma0, and break-away falls as the force rises faster",
      .passivity =
          "at unbounded speed if and only if sigma2/sigma1 >= (Fs - Fc)/Fc (constant sigma1); the published "
          "values have sigma2/sigma1 = 0 or 0.0013 against 0.5 and are not passive",
      .evidence =
          "equation read in the source documents and in public code, as are the values of 1995; the passivity "
          "condition was derived again and checked numerically (its paper is quoted from knowledge); "
          "sigma1 fading with speed (vd) is quoted from knowledge, not confirmed"};

  static std::vector<Parameter<LuGre, S>> parameters() {
    auto table = StribeckCurve<S>::template stribeck_table<LuGre>();
    table.push_back({"sigma0", "N/m", "bristle stiffness", &LuGre::sigma0, positive});
    table.push_back({"sigma1", "N s/m", "bristle damping", &LuGre::sigma1, not_negative, false});
    table.push_back({"sigma2", "N s/m", "viscous friction", &LuGre::sigma2, not_negative, false});
    table.push_back({"vd", "m/s", "velocity over which sigma1 fades; 0: never", &LuGre::vd, not_negative, false});
    return table;
  }
  std::optional<BrokenRule> validate() const { return this->validate_levels(); }

  int states() const { return 1; }
  void rate(const Input<S>& in, Mode, std::span<const S> z, std::span<S> dz) const {
    using std::abs;
    dz[0] = in.v - sigma0 * abs(in.v) * z[0] / this->level(in.v);
  }
  S output(const Input<S>& in, Mode mode, std::span<const S> z) const {
    using std::exp;
    S dz[1];
    rate(in, mode, z, dz);
    S damping = sigma1;
    if (vd > 0.0) damping = sigma1 * exp(-(in.v / vd) * (in.v / vd));  // vd = 0 means "constant", not a limit
    return sigma0 * z[0] + damping * dz[0] + sigma2 * in.v;
  }
  bool is_linear_in_state() const { return true; }
  bool has_constant_damping() const { return !(vd > 0.0); }
  LinearRate<S> linear_rate(const Input<S>& in) const {
    using std::abs;
    return {in.v, sigma0 * abs(in.v) / this->level(in.v)};
  }
  LinearOutput<S> linear_output(const Input<S>& in) const {
    using std::exp;
    if (vd > 0.0) return {sigma0, sigma1 * exp(-(in.v / vd) * (in.v / vd)), sigma2 * in.v};
    return {sigma0, sigma1, sigma2 * in.v};
  }
  /// Energy of the bristles, sigma0 z^2/2.
  S storage(Mode, std::span<const S> z) const { return S(0.5) * sigma0 * z[0] * z[0]; }
  bool odd() const { return this->symmetric(); }
  Mode mirror(Mode mode) const { return mode; }
  Scales scales() const {
    const double velocity = vd > 0.0 ? std::min(value_of(this->vs), value_of(vd)) : value_of(this->vs);
    return {.displacement = value_of(this->Fs / sigma0), .velocity = velocity, .output = value_of(this->Fs)};
  }
  double state_scale(int) const { return value_of(this->Fs / sigma0); }
};

}  // namespace limcycle
