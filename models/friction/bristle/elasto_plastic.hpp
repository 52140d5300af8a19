#pragma once
#include <algorithm>
#include <numbers>

#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/levels.hpp"

namespace limcycle {

/// Single-state elasto-plastic friction:
///   dz/dt = v (1 - a(z, v) sigma0 s z/g(v)), s = sgn(v),   F = sigma0 z + sigma1(v) dz/dt + sigma2 v,
///   a = 0 for s z <= z_ba (so also where z opposes v), 1 for s z >= z_ss = g(v)/sigma0, in between
///   a = 1/2 + 1/2 sin(pi (s z - (z_ss + z_ba)/2)/(z_ss - z_ba)) = sin^2((pi/2) (s z - z_ba)/(z_ss - z_ba)).
/// z_ba = zba_ratio z_ss(v), or zba_ratio Fc/sigma0: below z_ss(v) at every v, as zba_ratio < 1 and g >= Fc. A fixed
/// share of z_ss(0) would not be, and is not offered. sigma1(v) as for LuGre. One state; local memory; |z| <= Fs/sigma0
/// is invariant. Dupont, Hayward, Armstrong, Altpeter (2002).
///
/// Modes: 0 for |z| <= z_ba, +-1 for the transition and +-2 for the plastic range on the side of that sign; the sign of
/// v shows whether that side is loaded. `a` leaves 0 and reaches 1 with zero slope, so that modes may overlap by
/// `overlap` (z_ss - z_ba) without effect: z at z_ss to rounding, as in steady sliding, switches once.
template <class S>
struct ElastoPlastic : StribeckCurve<S> {
  S sigma0{}, sigma1{0.0}, sigma2{0.0}, vd{0.0}, zba_ratio{0.69};
  Choice zba_of{};

  static constexpr std::string_view kind = "elasto-plastic";
  static constexpr bool is_one_state = true;
  static constexpr bool output_needs_rate = true;
  static constexpr std::string_view zba_kinds[] = {"steady-state", "coulomb"};
  static constexpr std::string_view equation =
      "dz/dt = v (1 - a(z, v) sigma0 s z/g(v)), s = sgn(v);  F = sigma0 z + sigma1 exp(-(v/vd)^2) dz/dt + sigma2 v "
      "(vd = 0: sigma1 constant);  a = 0 for s z <= z_ba, 1 for s z >= z_ss = g/sigma0, else 1/2 + 1/2 sin(pi (s z - "
      "(z_ss + z_ba)/2)/(z_ss - z_ba));  z_ba = zba_ratio g(v)/sigma0 (steady-state) or zba_ratio Fc/sigma0 (coulomb); "
      " g = Fc + (Fs - Fc) exp(-|v/vs|^delta)";
  static constexpr std::string_view source = "Dupont, Hayward, Armstrong, Altpeter (2002), IEEE TAC 47(5), 787-792";
  static constexpr Features features{
      .memory = Memory::local,
      .drifts = true,
      .drift =
          "none while |F| < sigma0 z_ba, that is zba_ratio Fs at rest (steady-state) or zba_ratio Fc (coulomb); "
          "drifts like LuGre above",
      .rate = "g(v) in sliding, sigma1 and sigma2 everywhere",
      .passivity = "passive for sigma1 = 0; with sigma1 the caveat of LuGre: sigma2/sigma1 >= (Fs - Fc)/Fc suffices",
      .evidence =
          "equations read in public code, with the test of sgn z = sgn v and |z| restored, which that code "
          "omits; title and pages confirmed, the paper itself not read"};

  static std::vector<Parameter<ElastoPlastic, S>> parameters() {
    auto table = StribeckCurve<S>::template stribeck_table<ElastoPlastic>();
    table.push_back({"sigma0", "N/m", "bristle stiffness", &ElastoPlastic::sigma0, positive});
    table.push_back({"sigma1", "N s/m", "bristle damping", &ElastoPlastic::sigma1, not_negative, false});
    table.push_back({"sigma2", "N s/m", "viscous friction", &ElastoPlastic::sigma2, not_negative, false});
    table.push_back(
        {"vd", "m/s", "velocity over which sigma1 fades; 0: never", &ElastoPlastic::vd, not_negative, false});
    table.push_back({"zba_ratio", "1", "elastic share of the deflection in sliding", &ElastoPlastic::zba_ratio,
                     Range{0.0, 1.0, true, true}, false});
    table.push_back({"zba_of", "1", "deflection that zba_ratio is a share of", &ElastoPlastic::zba_of, any_number,
                     false, "", zba_kinds});
    return table;
  }
  std::optional<BrokenRule> validate() const { return this->validate_levels(); }

  /// Deflection in steady sliding at that speed, z_ss, and at the onset of sliding, z_ba, m; both > 0.
  S steady_deflection(const S& speed, bool forward) const { return this->level(speed, forward) / sigma0; }
  S elastic_deflection(const S& speed, bool forward) const {
    if (zba_of.index == 0) return zba_ratio * steady_deflection(speed, forward);
    return zba_ratio * (forward ? this->Fc : this->Fc_minus) / sigma0;
  }

  int states() const { return 1; }
  void rate(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const {
    dz[0] = in.v;
    if (mode.value == 0 || !(side(mode) * in.v > 0.0)) return;
    const Bounds at = bounds(in, forward(mode));
    const S deflection = side(mode) * z[0];
    dz[0] = in.v * (S(1.0) - plastic_share(mode, deflection, at) * deflection / at.steady);
  }
  S output(const Input<S>& in, Mode mode, std::span<const S> z) const {
    using std::exp;
    S dz[1];
    rate(in, mode, z, dz);
    S damping = sigma1;
    if (vd > 0.0) damping = sigma1 * exp(-(in.v / vd) * (in.v / vd));  // vd = 0 means "constant", not a limit
    return sigma0 * z[0] + damping * dz[0] + sigma2 * in.v;
  }

  /// Energy of the bristles.
  S storage(Mode, std::span<const S> z) const { return S(0.5) * sigma0 * z[0] * z[0]; }

  int guards(Mode mode) const { return mode.value == 2 || mode.value == -2 ? 1 : 2; }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
    if (mode.value == 0) {
      g[0] = bounds(in, true).elastic_end() - z[0];
      g[1] = bounds(in, false).elastic_end() + z[0];
      return;
    }
    const Bounds at = bounds(in, forward(mode));
    const S deflection = side(mode) * z[0];
    if (guards(mode) == 2) {
      g[0] = deflection - at.elastic;
      g[1] = at.steady - deflection;
    } else {
      g[0] = deflection - at.plastic_end();
    }
  }
  Mode next(const Input<S>&, Mode mode, std::span<S>, int fired) const {
    if (mode.value == 0) return {fired == 0 ? 1 : -1};
    const int to = mode.value > 0 ? 1 : -1;
    return {guards(mode) == 1 ? to : fired == 0 ? 0 : 2 * to};
  }
  Mode start(const Input<double>& in, std::span<double> z) const {
    const int to = z[0] < 0.0 ? -1 : 1;
    const Bounds at = bounds(Input<S>{S(in.x), S(in.v), S(in.drive)}, to > 0);
    const double deflection = to * z[0];
    return {at.steady < deflection ? 2 * to : at.elastic < deflection ? to : 0};
  }

  /// State and mode after long sliding at in.v.
  Mode after_sliding(const Input<double>& in, std::span<double> z) const {
    const int to = in.v < 0.0 ? -1 : 1;
    z[0] = to * value_of(steady_deflection(S(std::abs(in.v)), to > 0));
    return {to > 0 ? 2 : -2};
  }

  bool odd() const { return this->symmetric(); }
  Mode mirror(Mode mode) const { return {-mode.value}; }
  Scales scales() const {
    const double velocity = vd > 0.0 ? std::min(value_of(this->vs), value_of(vd)) : value_of(this->vs);
    return {.displacement = value_of(this->Fs / sigma0), .velocity = velocity, .output = value_of(this->Fs)};
  }
  double state_scale(int) const { return value_of(this->Fs / sigma0); }

 private:
  static constexpr double overlap = 1e-8;  // a = (pi/2 overlap)^2 = 2.5e-16 there
  struct Bounds {
    S elastic, steady;
    S elastic_end() const { return elastic + S(overlap) * (steady - elastic); }
    S plastic_end() const { return steady - S(overlap) * (steady - elastic); }
  };
  static bool forward(Mode mode) { return mode.value > 0; }
  static S side(Mode mode) { return S(forward(mode) ? 1.0 : -1.0); }
  Bounds bounds(const Input<S>& in, bool forward) const {
    using std::abs;
    const S speed = abs(in.v);
    return {elastic_deflection(speed, forward), steady_deflection(speed, forward)};
  }
  static S plastic_share(Mode mode, const S& deflection, const Bounds& at) {
    using std::sin;
    if (mode.value == 2 || mode.value == -2) return S(1.0);
    const S half = sin(S(0.5 * std::numbers::pi) * (deflection - at.elastic) / (at.steady - at.elastic));
    return half * half;
  }
};

}  // namespace limcycle
