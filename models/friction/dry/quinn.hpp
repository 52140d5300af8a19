#pragma once
#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/force_band.hpp"

namespace limcycle {

/// Quinn's regularisation of dry friction: in a layer |v| <= dv the force changes linearly with |v|/dv, from the
/// applied force (up to Fs), which it balances, to the sliding level:
///   F = (1 - |v|/dv) sat(Fs; drive) + (|v|/dv) g(v) sgn(v) + sigma2 v;   outside F = g(v) sgn(v) + sigma2 v.
/// Continuous; v = 0 is an exact equilibrium while |drive| <= Fs, and is approached as exp(-t (g - |drive|)/(m dv)):
/// rest without creep. No state. Quinn (2004), J. Vib. Acoust. 126, 391-397.
template <class S>
struct Quinn : ForceBand<S> {
  using typename ForceBand<S>::Place;

  static constexpr std::string_view kind = "quinn";
  static constexpr std::string_view equation =
      "|v| <= dv: F = (1 - |v|/dv) sat(Fs; applied force) + (|v|/dv) g(v) sgn(v) + sigma2 v;  |v| > dv: F = g(v) "
      "sgn(v) "
      "+ sigma2 v;  g = Fc + (Fs - Fc) exp(-|v/vs|^delta)";
  static constexpr std::string_view source = "Quinn (2004), J. Vib. Acoust. 126, 391-397; form not confirmed";
  static constexpr Features features{
      .memory = Memory::none,
      .drifts = false,
      .drift = "none: v = 0 is an equilibrium while the applied force stays below Fs, reached exponentially",
      .rate = "the Stribeck curve, the layer |v| < dv, and sigma2 v",
      .passivity =
          "not from v to F alone: in the layer the force may have the sign of the applied force, against v or "
          "with it, as at rest; outside the layer yes, g > 0",
      .evidence =
          "the equation was not found: a reconstruction from the idea (a boundary layer that uses the applied "
          "force, so that v = 0 is an equilibrium), with g(v) in the place of Fc"};

  static std::vector<Parameter<Quinn, S>> parameters() {
    auto table = StribeckCurve<S>::template stribeck_table<Quinn>();
    table.push_back({"dv", "m/s", "half-width of the zero-velocity band", &Quinn::dv, positive});
    table.push_back({"sigma2", "N s/m", "viscous friction", &Quinn::sigma2, not_negative, false});
    return table;
  }
  std::optional<BrokenRule> validate() const { return this->validate_levels(); }

  S output(const Input<S>& in, Mode mode, std::span<const S>) const {
    using std::abs;
    const Place at = Place::of(mode);
    const S viscous = this->sigma2 * in.v;
    if (at.outside != 0) return this->sliding(at, in.v) + viscous;
    const bool forward = this->is_forward(at, in.v);
    const S weight = (forward ? in.v : -in.v) / this->dv, g = this->level(abs(in.v), forward);
    return (S(1.0) - weight) * this->balanced(at, in.drive) + weight * (forward ? g : -g) + viscous;
  }
};

}  // namespace limcycle
