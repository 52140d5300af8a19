#pragma once
#include <algorithm>
#include <cmath>

#include "limcycle/models/friction/branch_curves.hpp"
#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/levels.hpp"
#include "limcycle/models/friction/return_points.hpp"

namespace limcycle {

/// Non-drift friction, a reconstruction of the source thesis' own law (its equations were not found; its text was):
///   q = f_h(z) + sigma v,   F = sat(s; q) + sigma2 v,   dz/dt = (sat(s; q) - f_h)/sigma   ( = v while |q| <= s),
///   tau ds/dt = g(v) - s,   s(0) = Fs   (tau = 0: s = g(v)),
/// f_h being a hysteresis of z with memory of its return points that starts at 0 and reaches Fs at z = Zb, driven by
/// the motion of z, not of x: where s falls while the body slides, z reverses.
///
/// Properties (derived): |F - sigma2 v| <= s <= Fs; passive from v to F for any parameters (memory "masing"), since
/// the slip rate w = v - dz/dt meets a force of size s and of its own sign; under a periodic force below Fc there is no
/// slip, so no drift; F = g(v) sgn(v) + sigma2 v in steady sliding; one solution for a given motion.
///
/// Memory "masing": a branch is the virgin curve doubled; "two-point": it is stretched between its return point and its
/// target, at first -+Fs on the other side (the literal reading; passivity checked on closed loops only). In repeated
/// sliding its loops shrink inwards from cycle to cycle and hardly settle, so that a describing function may end in
/// max_iterations there; without slip, and with masing, they do settle. (With either, slow sliding in one direction,
/// v << vs, takes many periods to bring z up to Zb.) With unequal levels for the two directions the masing curve is
/// that of the higher break-away level. States: those of ReturnPoints (paths of z, at most 12 return points), then the
/// lagged share b of the break-away level, s = Fc + (Fs - Fc) b, for both directions. Modes: those of ReturnPoints; in
/// the bits above, 0 below the cap, 1 and 2 at the upper and lower cap. Cost: one curve a return point.
template <class S>
struct NonDrift : StribeckCurve<S> {
  S Zb{}, sigma{}, tau{}, shape{5.0}, sigma2{0.0};
  Choice branch{}, memory{};
  static constexpr std::string_view branches[] = {"koizumi-shibazaki", "exponential", "rational", "linear"};
  static constexpr std::string_view memories[] = {"masing", "two-point"};

  static constexpr bool output_needs_rate = true;
  static constexpr std::string_view kind = "non-drift";
  static constexpr bool keeps_return_points = true;
  static constexpr std::string_view equation =
      "q = f_h(z) + sigma v;  F = sat(s; q) + sigma2 v;  dz/dt = (sat(s; q) - f_h)/sigma;  tau ds/dt = g(v) - s;  f_h "
      "= "
      "f_r + (F_t - f_r) phi((z - z_r)/(z_t - z_r)) between return point r and target t, phi = xi (1 - ln xi) | (1 - "
      "exp(-shape xi))/(1 - exp(-shape)) | (1 + shape) xi/(1 + shape xi) | xi;  g = Fc + (Fs - Fc) exp(-|v/vs|^delta)";
  static constexpr std::string_view source =
      "the source thesis, sections 3.2.1 and 3.6: a reconstruction from its text";
  static constexpr Features features{
      .memory = Memory::non_local,
      .drifts = false,
      .drift =
          "none: the level s is never below Fc, so a force below Fc causes no slip and every loop closes (two-point: "
          "up to some 1e-8 m, a branch ending with no stiffness)",
      .rate = "the micro-damping sigma before sliding, the lag tau of the level in sliding, and sigma2 v",
      .passivity = "yes, for any parameters, with memory masing; with two-point every closed loop dissipates",
      .evidence =
          "RECONSTRUCTION: the thesis' equations 3.1 and 3.2 were not found. Parameters, return points, target "
          "force Fs, no drift and the Stribeck curve stand in its text; the branch curve, what tau and sigma act "
          "on, and the rule after a reversal are proposals. Its statement that break-away rises with the rate "
          "of force is not reproduced"};

  static std::vector<Parameter<NonDrift, S>> parameters() {
    auto table = StribeckCurve<S>::template stribeck_table<NonDrift>();
    table.push_back({"Zb", "m", "displacement at which the virgin curve reaches Fs", &NonDrift::Zb, positive});
    table.push_back({"sigma", "N s/m", "micro-damping before sliding", &NonDrift::sigma, positive});
    table.push_back({"tau", "s", "lag of the sliding level; 0: none", &NonDrift::tau, not_negative});
    table.push_back({"branch", "1", "curve of a branch", &NonDrift::branch, any_number, false, "", branches});
    table.push_back({"shape", "1", "of the exponential and the rational curve", &NonDrift::shape, positive, false});
    table.push_back({"memory", "1", "rule after a reversal", &NonDrift::memory, any_number, false, "", memories});
    table.push_back({"sigma2", "N s/m", "viscous friction", &NonDrift::sigma2, not_negative, false});
    return table;
  }
  std::optional<BrokenRule> validate() const { return this->validate_levels(); }

  int states() const { return Stack::states + 1; }
  void rate(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const {
    const ReturnMode at = ReturnMode::of(mode);
    for (std::size_t i = 0; i < share; ++i) dz[i] = S(0.0);
    if (!at.saturated) {
      const int side = cap_of(mode);
      dz[0] = static_cast<double>(at.direction) *
              (side == 0 ? in.v : (side * cap(in, z[share], side) - hysteresis(at, z)) / sigma);
    }
    dz[share] = tau > 0.0 ? (sliding_share(in.v) - z[share]) / tau : S(0.0);
  }
  S output(const Input<S>& in, Mode mode, std::span<const S> z) const {
    const int side = cap_of(mode);
    const S capped = side == 0 ? hysteresis(ReturnMode::of(mode), z) + sigma * in.v : side * cap(in, z[share], side);
    return capped + sigma2 * in.v;
  }

  /// Energy of the stop elements equivalent to f_h; two-point branches have no such elements and no known energy.
  bool has_storage() const { return memory.index == 0; }
  S storage(Mode mode, std::span<const S> z) const {
    const Curve rule(*this);
    return has_storage() ? Stack{rule}.energy(ReturnMode::of(mode), z) : S(0.0);
  }

  /// The rate of z along its branch, and the path left to its end; below the cap the distances from the upper and the
  /// lower cap, at a cap the excess of the trial force over it. A rate of rounding size does not reverse the branch.
  int guards(Mode mode) const { return cap_of(mode) == 0 ? 4 : 3; }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
    const ReturnMode at = ReturnMode::of(mode);
    const Curve rule(*this);
    const double d = at.direction;
    const int side = cap_of(mode);
    const S held = Stack{rule}.force(at, z), trial = held + sigma * in.v;
    g[1] = Stack{rule}.way_left(at, z);
    if (side == 0) {
      g[0] = d * in.v + 1e-13 * slowest();
      g[2] = cap(in, z[share], 1) - trial;
      g[3] = cap(in, z[share], -1) + trial;
    } else {
      const S most = side * cap(in, z[share], side);
      g[0] = d * (most - held) + turning * value_of(this->Fs);
      g[2] = side * (trial - most);
    }
  }
  Mode next(const Input<S>&, Mode mode, std::span<S> z, int fired) const {
    const ReturnMode at = ReturnMode::of(mode);
    const Curve rule(*this);
    if (fired == 0) return Stack{rule}.reverse(at, z).in(mode);
    if (fired == 1) return Stack{rule}.arrive(at, z).in(mode);
    return with_cap(mode, cap_of(mode) != 0 ? 0 : fired == 2 ? 1 : -1);
  }
  /// No deflection, the level at Fs.
  Mode start(const Input<double>& in, std::span<double> z) const {
    const Mode mode = Stack::start(in, z).in({});
    z[share] = tau > 0.0 ? 1.0 : 0.0;
    const double trial = value_of(sigma) * in.v;
    const double most = value_of(cap(Input<S>{S(in.x), S(in.v), S(in.drive)}, S(z[share]), in.v < 0.0 ? -1 : 1));
    return with_cap(mode, trial > most ? 1 : trial < -most ? -1 : 0);
  }

  bool is_passive() const { return memory.index == 0; }
  /// |F - sigma2 v| <= Fs.
  std::optional<double> force_bound(double speed) const { return this->bound_with_viscous(sigma2, speed); }
  bool odd() const { return this->symmetric(); }
  Mode mirror(Mode mode) const { return with_cap(Stack::mirror(mode), -cap_of(mode)); }
  bool even_state(int) const { return true; }
  static bool unused(Mode mode, int i) { return Stack::unused(mode, i); }
  Scales scales() const { return {.displacement = value_of(Zb), .velocity = slowest(), .output = value_of(this->Fs)}; }
  double state_scale(int i) const {
    return i == static_cast<int>(share) ? 1.0 : Stack::state_scale(i, value_of(Zb), value_of(this->Fs));
  }

 private:
  /// The hysteresis as a shape for ReturnPoints.
  struct Curve {
    const NonDrift& law;
    S end;
    bool masing;

    explicit Curve(const NonDrift& owner) : law(owner), end(owner.Zb), masing(owner.memory.index == 0) {}
    const S& level(double direction) const {
      if (masing) return law.Fs < law.Fs_minus ? law.Fs_minus : law.Fs;
      return direction < 0.0 ? law.Fs_minus : law.Fs;
    }
    S virgin(const S& way, double direction) const { return level(direction) * phi(way / law.Zb); }
    S virgin_energy(const S& way) const { return level(1.0) * law.Zb * energy(way / law.Zb); }
    S energy(const S& xi) const {
      switch (law.branch.index) {
        case 0:
          return koizumi_shibazaki_energy(xi);
        case 1:
          return exponential_energy(xi, law.shape);
        case 2:
          return rational_energy(xi, law.shape);
        default:
          return 0.5 * xi * xi;
      }
    }
    S phi(const S& xi) const {
      switch (law.branch.index) {
        case 0:
          return koizumi_shibazaki_curve(xi);
        case 1:
          return exponential_curve(xi, law.shape);
        case 2:
          return rational_curve(xi, law.shape);
        default:
          return xi;
      }
    }
  };
  using Stack = ReturnPoints<S, Curve>;
  static constexpr std::size_t share = Stack::states;
  /// In sliding z follows the level at a rate that is almost zero; it reverses when f_h exceeds the level by this share
  /// of Fs. The force is that of the level, whatever z does.
  static constexpr double turning = 1e-9;

  static int cap_of(Mode mode) {
    const auto code = mode.value >> ReturnMode::bits & 3;
    return code == 2 ? -1 : static_cast<int>(code);
  }
  static Mode with_cap(Mode mode, int side) {
    const std::int64_t code = side < 0 ? 2 : side;
    return {(mode.value & ~(std::int64_t{3} << ReturnMode::bits)) | code << ReturnMode::bits};
  }

  S hysteresis(ReturnMode at, std::span<const S> z) const {
    const Curve rule(*this);
    return Stack{rule}.force(at, z);
  }
  /// (g(v) - Fc)/(Fs - Fc), common to both directions.
  S sliding_share(const S& v) const {
    StribeckCurve<S> unit = *this;
    unit.Fs = unit.Fs_minus = S(1.0);
    unit.Fc = unit.Fc_minus = S(0.0);
    return unit.level(v);
  }
  /// The level s of the upper (+1) or lower (-1) cap, N.
  S cap(const Input<S>& in, const S& b, int side) const {
    const S part = tau > 0.0 ? b : sliding_share(in.v);
    return side < 0 ? this->Fc_minus + (this->Fs_minus - this->Fc_minus) * part
                    : this->Fc + (this->Fs - this->Fc) * part;
  }
  double slowest() const { return std::min(value_of(this->vs), value_of(this->Fs / sigma)); }
};

}  // namespace limcycle
