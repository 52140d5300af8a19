#pragma once
#include <algorithm>

#include "limcycle/models/friction/bristle/lugre_bristle.hpp"
#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/measured_curve.hpp"

namespace limcycle {

/// LuGre friction over a curve as it was measured (see LuGreBristle, MeasuredCurve).
template <class S>
struct LuGreTable : LuGreBristle<S, MeasuredCurve<S>> {
  static constexpr std::string_view kind = "lugre-table";
  static constexpr std::string_view equation =
      "dz/dt = v - sigma0 |v| z/g(v);  F = sigma0 z + sigma1 exp(-(v/vd)^2) dz/dt + sigma2 v (vd = 0: sigma1 "
      "constant);  g through (0, Fs) and the points (velocities, forces), monotone between them, straight beyond the "
      "last";
  static constexpr std::string_view source =
      "Canudas de Wit, Olsson, Astrom, Lischinsky (1995), IEEE TAC 40(3), 419-425; measured points, interpolation "
      "after "
      "Fritsch and Butland (1984), quoted from knowledge";
  static constexpr Features features{
      .memory = Memory::local,
      .drifts = true,
      .drift = "ratchets under a biased periodic force of any size, as lugre does",
      .rate = "sigma1 in pre-sliding, g(v) and sigma2 v in sliding, with a lag over the distance g/sigma0",
      .passivity = "depends on the points: sigma2/sigma1 must make up for the fall of g from Fs (lugre)",
      .evidence =
          "the bristle as of lugre; what was measured between its points is assumed to be smooth and monotone, "
          "and a straight line beyond the last point is a guess"};

  static std::vector<Parameter<LuGreTable, S>> parameters() {
    auto table = MeasuredCurve<S>::template curve_table<LuGreTable>();
    LuGreTable::append_bristle(table);
    return table;
  }
  std::optional<BrokenRule> validate() const { return this->validate_curve(); }

  bool odd() const { return this->symmetric(); }
  Scales scales() const {
    const double closest = this->velocity_scale();
    return {.displacement = value_of(this->Fs / this->sigma0),
            .velocity = this->vd > 0.0 ? std::min(closest, value_of(this->vd)) : closest,
            .output = value_of(this->Fs)};
  }
  double state_scale(int) const { return this->highest_level() / value_of(this->sigma0); }
};

}  // namespace limcycle
