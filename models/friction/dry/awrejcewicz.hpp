#pragma once
#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/force_band.hpp"

namespace limcycle {

/// Dry friction of Awrejcewicz, Grzelczyk and Pyryev: with A3 = (v/dv)^2 (3 - 2 |v|/dv) and the applied force Fe,
///   |v| > dv:               F = g(v) sgn(v)
///   |v| <= dv, |Fe| <= Fs:  F = A3 (Fs sgn(v) - Fe) + Fe
///   |v| <= dv, Fe beyond Fs in the direction of v: Fs sgn(v); against it: (2 A3 - 1) Fs sgn(v)
/// plus sigma2 v. The three lines for the band are one: F = (1 - A3) sat(Fs; Fe) + A3 Fs sgn(v). Continuous except at
/// |v| = dv, where it falls from Fs to g(dv), by (Fs - Fc)(dv/vs)^2 for dv << vs. No state.
///
/// v = 0 is an equilibrium while |Fe| <= Fs, but v approaches it only as m dv^2/(3 (Fs - |Fe|) t): a body coming to
/// rest creeps with the logarithm of time. Awrejcewicz, Grzelczyk, Pyryev (2008), J. Vibroengineering 10(4), 475-482.
template <class S>
struct Awrejcewicz : ForceBand<S> {
  using typename ForceBand<S>::Place;

  static constexpr std::string_view kind = "awrejcewicz";
  static constexpr std::string_view equation =
      "|v| <= dv: F = (1 - A3) sat(Fs; applied force) + A3 Fs sgn(v) + sigma2 v, A3 = (v/dv)^2 (3 - 2 |v|/dv);  |v| > "
      "dv: F = g(v) sgn(v) + sigma2 v;  g = Fc + (Fs - Fc) exp(-|v/vs|^delta)";
  static constexpr std::string_view source =
      "Awrejcewicz, Grzelczyk, Pyryev (2008), J. Vibroengineering 10(4), 475-482; as quoted in reviews";
  static constexpr Features features{
      .memory = Memory::none,
      .drifts = false,
      .drift =
          "none from exact rest; a body that comes to rest slows down as 1/t in the band and so moves on by the "
          "logarithm of time",
      .rate = "the Stribeck curve, the band |v| < dv, and sigma2 v",
      .passivity =
          "not from v to F alone: in the band the force may have the sign of the applied force, against v or "
          "with it, as at rest; outside the band yes, g > 0",
      .evidence =
          "the paper was not found; its cases are quoted from knowledge of reviews (Pennestri et al. 2016, whose "
          "formula could not be read)"};

  static std::vector<Parameter<Awrejcewicz, S>> parameters() {
    auto table = StribeckCurve<S>::template stribeck_table<Awrejcewicz>();
    table.push_back({"dv", "m/s", "half-width of the zero-velocity band", &Awrejcewicz::dv, positive});
    table.push_back({"sigma2", "N s/m", "viscous friction", &Awrejcewicz::sigma2, not_negative, false});
    return table;
  }
  std::optional<BrokenRule> validate() const { return this->validate_levels(); }

  S output(const Input<S>& in, Mode mode, std::span<const S>) const {
    const Place at = Place::of(mode);
    const S viscous = this->sigma2 * in.v;
    if (at.outside != 0) return this->sliding(at, in.v) + viscous;
    const bool forward = this->is_forward(at, in.v);
    const S part = (forward ? in.v : -in.v) / this->dv, weight = part * part * (S(3.0) - S(2.0) * part);
    return (S(1.0) - weight) * this->balanced(at, in.drive) + weight * (forward ? this->Fs : -this->Fs_minus) + viscous;
  }
};

}  // namespace limcycle
