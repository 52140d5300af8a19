#pragma once
#include <cmath>

#include "limcycle/models/friction/branch_curves.hpp"
#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/levels.hpp"
#include "limcycle/models/friction/return_points.hpp"

namespace limcycle {

/// Two-state friction with elasto-plasticity (2SEP), a reconstruction from the text of Ruderman and Bertram (2013):
///   pre-sliding  F = F_r + (F_t - F_r) phi(|x - x_r|/|x_t - x_r|) + sigma2 v,  phi(xi) = xi (1 - ln xi),
/// between the last return point (x_r, F_r) and its target: the previous return point or, at first break-away, Fs in
/// the direction of motion, at a distance s from the origin; after sliding, 2 s away.
///   sliding      F = d b + sigma2 v,  tau db/dt = g(v) - b,
/// entered with b = Fs when a branch reaches break-away, and left, at F_r = d b, when the motion reverses. So
/// pre-sliding has all the weight before break-away and the level has it after: the simplest weighting with a
/// continuous force.
///
/// A closed loop returns to its initial force, with dissipation. No drift as long as the force stays below the
/// break-away level. F = g(v) sgn(v) + sigma2 v in steady sliding; |F - sigma2 v| <= max Fs. With tau = 0 the force
/// jumps from Fs to g(v) at break-away. States: those of ReturnPoints, then b (N), constant without sliding. Modes:
/// those of ReturnPoints. The slope at a reversal is infinite, see koizumi_shibazaki_curve.
template <class S>
struct TwoState : StribeckCurve<S> {
  S s{}, tau{}, sigma2{0.0};

  static constexpr bool output_needs_rate = true;
  static constexpr std::string_view kind = "two-state";
  static constexpr bool keeps_return_points = true;
  static constexpr std::string_view equation =
      "pre-sliding: F = F_r + (F_t - F_r) xi (1 - ln xi), xi = |x - x_r|/|x_t - x_r|, between return point r and "
      "target t "
      "(at first: Fs at s);  sliding: F = b sgn(v), tau db/dt = g(v) - b, b = Fs at break-away;  + sigma2 v;  g = Fc + "
      "(Fs - Fc) exp(-|v/vs|^delta)";
  static constexpr std::string_view source =
      "after Ruderman and Bertram (2013), Mech. Syst. Signal Process. 39, 316-332: a reconstruction from its gist";
  static constexpr Features features{
      .memory = Memory::non_local,
      .drifts = false,
      .drift =
          "none to speak of below break-away: return points are kept and loops close, up to some 1e-8 m where a branch "
          "ends with no stiffness (the force never quite arrives there)",
      .rate = "in sliding: the lag tau of the level; besides sigma2 v; none before sliding for sigma2 = 0",
      .passivity = "not established; closed pre-sliding loops dissipate",
      .evidence =
          "RECONSTRUCTION: the paper was not found. Pre-sliding by the Koizumi-Shibazaki curve between return "
          "points and a first-order lag towards the Stribeck level are its gist, quoted from knowledge; the "
          "weighting between them is a proposal"};

  static std::vector<Parameter<TwoState, S>> parameters() {
    auto table = StribeckCurve<S>::template stribeck_table<TwoState>();
    table.push_back({"s", "m", "pre-sliding distance", &TwoState::s, positive});
    table.push_back({"tau", "s", "lag of the sliding level; 0: none", &TwoState::tau, not_negative});
    table.push_back({"sigma2", "N s/m", "viscous friction", &TwoState::sigma2, not_negative, false});
    return table;
  }
  std::optional<BrokenRule> validate() const { return this->validate_levels(); }

  int states() const { return Stack::states + 1; }
  void rate(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const {
    const ReturnMode at = ReturnMode::of(mode);
    for (std::size_t i = 0; i <= lagged; ++i) dz[i] = S(0.0);
    if (!at.saturated)
      dz[0] = static_cast<double>(at.direction) * in.v;
    else if (tau > 0.0)
      dz[lagged] = (this->level(speed(in, at), at.direction > 0) - z[lagged]) / tau;
  }
  S output(const Input<S>& in, Mode mode, std::span<const S> z) const {
    const ReturnMode at = ReturnMode::of(mode);
    return (at.saturated ? static_cast<double>(at.direction) * sliding_level(in, at, z) : pre_sliding(at, z)) +
           sigma2 * in.v;
  }

  /// The velocity along the branch, and the path left to its end. A velocity of rounding size does not reverse it.
  int guards(Mode) const { return 2; }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
    const ReturnMode at = ReturnMode::of(mode);
    const PreSliding branches(*this, z[lagged]);
    g[0] = static_cast<double>(at.direction) * in.v + 1e-13 * value_of(this->vs);
    g[1] = Stack{branches}.way_left(at, z);
  }
  Mode next(const Input<S>&, Mode mode, std::span<S> z, int fired) const {
    const ReturnMode at = ReturnMode::of(mode);
    const PreSliding branches(*this, z[lagged]);
    const ReturnMode after = fired == 0 ? Stack{branches}.reverse(at, z) : Stack{branches}.arrive(at, z);
    // Break-away begins at Fs; a return point left in sliding keeps its level.
    const bool virgin_turned = fired == 0 && at.depth == 0 && after.depth == 0;
    if (fired == 1 ? at.depth < 2 : virgin_turned) z[lagged] = break_away(after.direction);
    const bool broke_away_and_turned = fired == 0 && at.depth % 2 == 1 && after.depth == 1;
    if (broke_away_and_turned) z[lagged] = break_away(at.direction);
    return after.in(mode);
  }
  Mode start(const Input<double>& in, std::span<double> z) const {
    const ReturnMode at = Stack::start(in, z);
    z[lagged] = value_of(break_away(at.direction));
    return at.in({});
  }

  /// |F - sigma2 v| <= Fs.
  std::optional<double> force_bound(double speed) const { return this->bound_with_viscous(sigma2, speed); }
  bool odd() const { return this->symmetric(); }
  Mode mirror(Mode mode) const { return Stack::mirror(mode); }
  bool even_state(int) const { return true; }
  static bool unused(Mode mode, int i) { return Stack::unused(mode, i); }
  Scales scales() const {
    return {.displacement = value_of(s), .velocity = value_of(this->vs), .output = value_of(this->Fs)};
  }
  double state_scale(int i) const { return Stack::state_scale(i, value_of(s), value_of(this->Fs)); }

 private:
  /// Pre-sliding as a shape for ReturnPoints; the outermost return point is at the level b.
  struct PreSliding {
    static constexpr bool masing = false;
    const TwoState& law;
    S end, b;

    PreSliding(const TwoState& owner, const S& level) : law(owner), end(owner.s), b(level) {}
    S level(double direction) const { return law.break_away(direction); }
    S virgin(const S& way, double) const { return b * phi(way / law.s); }
    S phi(const S& xi) const { return koizumi_shibazaki_curve(xi); }
  };
  using Stack = ReturnPoints<S, PreSliding>;
  friend struct PreSliding;
  static constexpr std::size_t lagged = Stack::states;

  S pre_sliding(ReturnMode at, std::span<const S> z) const {
    const PreSliding branches(*this, z[lagged]);
    return Stack{branches}.force(at, z);
  }
  S sliding_level(const Input<S>& in, ReturnMode at, std::span<const S> z) const {
    return tau > 0.0 ? z[lagged] : this->level(speed(in, at), at.direction > 0);
  }
  const S& break_away(double direction) const { return direction < 0.0 ? this->Fs_minus : this->Fs; }
  static S speed(const Input<S>& in, ReturnMode at) {
    const S forward = static_cast<double>(at.direction) * in.v;
    return select(forward < 0.0, -forward, forward);
  }
};

}  // namespace limcycle
