#pragma once
#include "limcycle/models/element/linear_state.hpp"

namespace limcycle {

/// The bristle of LuGre friction over any curve of the sliding level g(v) > 0, which `Curve` offers as `level(v)`:
///   dz/dt = v - sigma0 |v| z / g(v),   F = sigma0 z + sigma1(v) dz/dt + sigma2 v,
/// with sigma1(v) = sigma1 exp(-(v/vd)^2) when vd > 0, else constant.
template <class S, class Curve>
struct LuGreBristle : Curve {
  S sigma0{}, sigma1{0.0}, sigma2{0.0}, vd{0.0};

  static constexpr bool is_one_state = true;
  static constexpr bool output_needs_rate = true;

  template <class Owner>
  static void append_bristle(std::vector<Parameter<Owner, S>>& table) {
    table.push_back({"sigma0", "N/m", "bristle stiffness", &Owner::sigma0, positive});
    table.push_back({"sigma1", "N s/m", "bristle damping", &Owner::sigma1, not_negative, false});
    table.push_back({"sigma2", "N s/m", "viscous friction", &Owner::sigma2, not_negative, false});
    table.push_back({"vd", "m/s", "velocity over which sigma1 fades; 0: never", &Owner::vd, not_negative, false});
  }

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
  Mode mirror(Mode mode) const { return mode; }
};

}  // namespace limcycle
