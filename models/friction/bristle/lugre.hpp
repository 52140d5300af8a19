#pragma once
#include <algorithm>

#include "limcycle/models/friction/bristle/lugre_bristle.hpp"
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
struct LuGre : LuGreBristle<S, StribeckCurve<S>> {
  static constexpr std::string_view kind = "lugre";
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
    LuGre::append_bristle(table);
    return table;
  }
  std::optional<BrokenRule> validate() const { return this->validate_levels(); }

  bool odd() const { return this->symmetric(); }
  Scales scales() const {
    const double velocity = this->vd > 0.0 ? std::min(value_of(this->vs), value_of(this->vd)) : value_of(this->vs);
    return {.displacement = value_of(this->Fs / this->sigma0), .velocity = velocity, .output = value_of(this->Fs)};
  }
  double state_scale(int) const { return value_of(this->Fs / this->sigma0); }
};

}  // namespace limcycle
