#pragma once
#include <cmath>
#include <cstdlib>
#include <optional>
#include <vector>

#include "limcycle/models/element/concepts.hpp"
#include "limcycle/models/friction/features.hpp"

namespace limcycle {

/// Bouc-Wen hysteresis:
///   F = alpha k x + (1 - alpha) k D z,   D dz/dt = A v - beta |v| |z|^(n-1) z - gamma v |z|^n,   z dimensionless.
/// One state; rate-independent; local memory. For beta >= 0 the set |z| <= z_max = (A/(beta + gamma))^(1/n) is
/// invariant, and the law passive; for beta < 0 neither holds: z may grow without bound after a reversal. n = 1,
/// gamma = 0, beta = A = 1, D = Fc/sigma0 is Dahl's law with exponent 1. Bouc (1967), Wen (1976).
///
/// Modes: the sign of z, because |z|^n has a kink (or, for non-integer n, a branch point) at z = 0; mode 0, which never
/// ends, where neither term has one (gamma = 0 and n odd, beta = 0 and n even). Towards a branch point |z| is divided
/// into bands, each a quarter of the previous one, so that panels and steps shrink with it: mode +-(1 + number of
/// band). The equations do not depend on the band.
template <class S>
struct BoucWen {
  S alpha{0.0}, k{}, D{}, A{1.0}, beta{}, gamma{}, n{1.0};

  static constexpr std::string_view kind = "bouc-wen";
  static constexpr bool is_one_state = true;
  static constexpr bool rate_independent = true;
  static constexpr std::string_view equation =
      "F = alpha k x + (1 - alpha) k D z;  D dz/dt = A v - beta |v| |z|^(n-1) z - gamma v |z|^n";
  static constexpr std::string_view source =
      "Bouc (1967), 4th Conf. Nonlinear Oscillation; Wen (1976), J. Eng. Mech. Div. ASCE 102";
  static constexpr Features features{
      .memory = Memory::local,
      .drifts = true,
      .drift = "drifts under biased forces, minor loops do not close; with alpha > 0 the spring alpha k ends the drift",
      .rate = "none: depends on the path only",
      .passivity =
          "passive for beta >= 0, as A > 0 and beta + gamma > 0 are asked for (-beta <= gamma <= beta is the "
          "sufficient condition of the literature); not for beta < 0, where z is not bounded either",
      .evidence =
          "equation and the sufficient condition from knowledge, published form not confirmed; passivity beyond "
          "that condition derived and checked by computation"};

  static std::vector<Parameter<BoucWen, S>> parameters() {
    return {{"alpha", "1", "share of the linear spring", &BoucWen::alpha, Range{0.0, 1.0}, false},
            {"k", "N/m", "stiffness", &BoucWen::k, positive},
            {"D", "m", "yield displacement", &BoucWen::D, positive},
            {"A", "1", "slope of z at z = 0", &BoucWen::A, positive, false},
            {"beta", "1", "curvature that turns with the motion", &BoucWen::beta},
            {"gamma", "1", "curvature that does not", &BoucWen::gamma},
            {"n", "1", "sharpness of the yield", &BoucWen::n, Range{1.0, infinite}, false}};
  }
  std::optional<BrokenRule> validate() const {
    if (!(beta + gamma > 0.0)) return BrokenRule{"gamma", "beta + gamma must be positive, else z grows without bound"};
    return std::nullopt;
  }

  /// Bound of |z|, approached in steady sliding.
  S largest() const { return power(A / (beta + gamma), S(1.0) / n); }

  int states() const { return 1; }
  /// True if a spring about x = 0 is part of the force.
  bool follows_position() const { return alpha != 0.0; }
  void rate(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const {
    const S with_sign = sign(in.v) * (mode.value == 0 ? odd_power(z[0]) : side(mode) * one_sided(side(mode) * z[0]));
    const S without = mode.value == 0 ? even_power(z[0]) : one_sided(side(mode) * z[0]);
    dz[0] = in.v * (A - beta * with_sign - gamma * without) / D;
  }
  S output(const Input<S>& in, Mode, std::span<const S> z) const {
    return alpha * k * in.x + (S(1.0) - alpha) * k * D * z[0];
  }

  /// Energy of the hysteretic part, (1 - alpha) k D^2 z^2/(2 A), without that of the spring, alpha k x^2/2. It proves
  /// passivity for |gamma| <= beta only.
  S storage(Mode, std::span<const S> z) const { return (S(1.0) - alpha) * k * D * D / (S(2.0) * A) * z[0] * z[0]; }

  int guards(Mode mode) const { return mode.value == 0 ? 0 : band(mode) == 0 ? 1 : 2; }
  void guard(const Input<S>&, Mode mode, std::span<const S> z, std::span<S> g) const {
    if (mode.value == 0) return;
    const S size = side(mode) * z[0];
    g[0] = band(mode) == innermost() ? size : size - S(1.0 - overlap) * edge(band(mode) + 1);
    if (band(mode) > 0) g[1] = S(1.0 + overlap) * edge(band(mode)) - size;
  }
  Mode next(const Input<S>&, Mode mode, std::span<S>, int fired) const {
    const std::int64_t outwards = mode.value < 0 ? -1 : 1;
    if (fired == 1) return {mode.value - outwards};
    return band(mode) == innermost() ? mirror(mode) : Mode{mode.value + outwards};
  }
  Mode start(const Input<double>& in, std::span<double> z) const {
    if (smooth()) return {0};
    const double ahead = z[0] != 0.0 ? z[0] : in.v != 0.0 ? in.v : in.drive;
    int at = 0;
    while (at < innermost() && std::abs(z[0]) < value_of(edge(at + 1))) ++at;
    return {ahead < 0.0 ? -1 - at : 1 + at};
  }

  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return {-mode.value}; }
  Scales scales() const {
    const double most = value_of(largest()), share = alpha < 1.0 ? 1.0 - value_of(alpha) : 1.0;
    return {.displacement = value_of(D / A) * most, .output = share * value_of(k * D) * most};
  }
  double state_scale(int) const { return value_of(largest()); }

 private:
  static constexpr double overlap = 0.05;  // of neighbouring bands
  bool is_whole(double divisor) const { return std::fmod(value_of(n), divisor) == 0.0; }
  bool smooth() const { return (gamma == 0.0 && is_whole(1.0) && !is_whole(2.0)) || (beta == 0.0 && is_whole(2.0)); }
  static S side(Mode mode) { return S(mode.value < 0 ? -1.0 : 1.0); }
  static int band(Mode mode) { return static_cast<int>(std::abs(mode.value)) - 1; }
  int innermost() const { return is_whole(1.0) ? 0 : 10; }  // 4^-10 = 1e-6: |z|^n is negligible against A there
  /// Outer edge of a band.
  S edge(int number) const { return largest() * S(std::ldexp(1.0, -2 * number)); }
  S even_power(const S& a) const { return a < 0.0 ? power(-a, n) : power(a, n); }
  S odd_power(const S& a) const { return a < 0.0 ? -power(-a, n) : power(a, n); }
  /// a^n, continued to a < 0 as smoothly as possible: a step that goes beyond the end of the mode stays smooth.
  S one_sided(const S& a) const { return is_whole(2.0) ? even_power(a) : odd_power(a); }
};

}  // namespace limcycle
