#pragma once
#include <cmath>

#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/levels.hpp"

namespace limcycle {

/// Hysteretic dry friction after Wojewoda, Stefanski, Wiercigroch and Kapitaniak: a pre-sliding spring, F = ks z with
/// dz/dt = v, until |F| reaches Fs; then slip with different curves for acceleration and deceleration,
///   F = sgn(v) (Fc + (Fs - Fc) h(|v|) sgn(v dv/dt)),   h = (g - Fc)/(Fs - Fc);   sigma2 v is added throughout.
/// At v = 0 the spring takes over with the final force of slip, sgn(v) (2 Fc - Fs).
///
/// In a loop dv/dt has the sign of drive - F. That makes the slip force, in the direction of motion, the drive clipped
/// to [2 Fc - g, g]: above the upper end F = g and the body accelerates, below the lower F = 2 Fc - g and it
/// decelerates, and in between only dv/dt = 0, F = drive, is consistent (sgn(0) being any value in [-1, 1]).
///
/// One state, z (m), 0 while slipping. Modes: 0 spring; +-1 decelerating, +-2 steady, +-3 accelerating, with the sign
/// of v. Under prescribed motion the sign of dv/dt is known, and so is F. Phil. Trans. R. Soc. A 366 (2008), 747-765.
template <class S>
struct Wojewoda : StribeckCurve<S> {
  S ks{}, sigma2{0.0};

  static constexpr bool output_needs_rate = true;
  static constexpr bool needs_drive = true;
  static constexpr std::string_view kind = "wojewoda";
  static constexpr std::string_view equation =
      "spring: F = ks z + sigma2 v, dz/dt = v, until ks |z| = Fs;  slip: F = sgn(v) (Fc + (g(v) - Fc) sgn(v dv/dt)) + "
      "sigma2 v, until v = 0;  g = Fc + (Fs - Fc) exp(-|v/vs|^delta)";
  static constexpr std::string_view source =
      "Wojewoda, Stefanski, Wiercigroch, Kapitaniak (2008), Phil. Trans. R. Soc. A 366(1866), 747-765; reconstruction";
  static constexpr Features features{
      .memory = Memory::local,
      .drifts = false,
      .drift = "none: below Fs the pre-sliding spring is elastic",
      .rate = "the Stribeck curve, the sign of the acceleration in slip, and sigma2 v",
      .passivity =
          "yes, for Fs <= 2 Fc and sigma2 >= 0 (storage ks z^2/2, and (2 Fc - Fs)^2/(2 ks) in slip); for Fs > 2 "
          "Fc the force drives a body that slows down",
      .evidence =
          "the equation was not confirmed: a reconstruction of what is commonly quoted (two curves, pre-sliding "
          "stiffness with a critical deflection); the steady branch follows from it"};

  static std::vector<Parameter<Wojewoda, S>> parameters() {
    auto table = StribeckCurve<S>::template stribeck_table<Wojewoda>();
    table.push_back({"ks", "N/m", "pre-sliding stiffness", &Wojewoda::ks, positive});
    table.push_back({"sigma2", "N s/m", "viscous friction", &Wojewoda::sigma2, not_negative, false});
    return table;
  }
  std::optional<BrokenRule> validate() const { return this->validate_levels(); }

  int states() const { return 1; }
  void rate(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> dz) const {
    dz[0] = mode.value == 0 ? in.v : S(0.0);
  }
  S output(const Input<S>& in, Mode mode, std::span<const S> z) const {
    const S viscous = sigma2 * in.v;
    if (mode.value == 0) return ks * z[0] + viscous;
    if (phase(mode) == steady) return in.drive;
    const S level = phase(mode) == faster ? upper(in.v, mode) : lower(in.v, mode);
    return (mode.value > 0 ? level : -level) + viscous;
  }

  /// Energy of the spring; in slip, of the spring that takes over at v = 0. It drops at break-away of the spring.
  S storage(Mode mode, std::span<const S> z) const {
    const S left = mode.value >= 0 ? S(2.0) * this->Fc - this->Fs : S(2.0) * this->Fc_minus - this->Fs_minus;
    return mode.value == 0 ? S(0.5) * ks * z[0] * z[0] : S(0.5) * left * left / ks;
  }

  int guards(Mode mode) const { return mode.value == 0 || phase(mode) != faster ? 2 : 1; }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
    if (mode.value == 0) {
      g[0] = this->Fs - ks * z[0];
      g[1] = this->Fs_minus + ks * z[0];
      return;
    }
    const S push = forwards(in, mode);
    switch (phase(mode)) {
      case slower:
        g[0] = lower(in.v, mode) - push;
        g[1] = mode.value > 0 ? in.v : -in.v;
        break;
      case steady:
        g[0] = upper(in.v, mode) - push;
        g[1] = push - lower(in.v, mode);
        break;
      default:
        g[0] = push - upper(in.v, mode);
    }
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S> z, int fired) const {
    if (mode.value == 0) {  // break-away of the spring
      z[0] = S(0.0);
      const std::int64_t side = fired == 0 ? 1 : -1;
      const double push = value_of(forwards(in, {side}));
      return {side * (push > value_of(upper(in.v, {side}))   ? faster
                      : push < value_of(lower(in.v, {side})) ? slower
                                                             : steady)};
    }
    const std::int64_t side = mode.value > 0 ? 1 : -1;
    const bool prescribed = std::isinf(value_of(in.drive));
    switch (phase(mode)) {
      case faster:
        return {side * (prescribed ? slower : steady)};
      case steady:
        return {side * (fired == 0 ? faster : slower)};
      default:
        if (fired == 0) return {side * (prescribed ? faster : steady)};
        z[0] = side > 0 ? (S(2.0) * this->Fc - this->Fs) / ks : -(S(2.0) * this->Fc_minus - this->Fs_minus) / ks;
        return {0};
    }
  }
  Mode start(const Input<double>&, std::span<double> z) const {
    z[0] = 0.0;
    return {0};
  }

  /// |F - sigma2 v| <= Fs, as 2 Fc - g >= -Fs.
  std::optional<double> force_bound(double speed) const { return this->bound_with_viscous(sigma2, speed); }
  /// In slip z is 0; at rest the spring takes over with 2 Fc - Fs, which is less than Fs in size for Fc >= 0.
  std::vector<std::pair<double, double>> state_bounds() const {
    return {{-value_of(this->Fs_minus / ks), value_of(this->Fs / ks)}};
  }
  bool odd() const { return this->symmetric(); }
  Mode mirror(Mode mode) const { return {-mode.value}; }
  Scales scales() const {
    return {.displacement = value_of(this->Fs / ks), .velocity = value_of(this->vs), .output = value_of(this->Fs)};
  }
  double state_scale(int) const { return value_of(this->Fs / ks); }

 private:
  static constexpr int slower = 1, steady = 2, faster = 3;
  static int phase(Mode mode) { return static_cast<int>(mode.value < 0 ? -mode.value : mode.value); }
  /// The drive without the viscous part, in the direction of motion.
  S forwards(const Input<S>& in, Mode mode) const {
    const S push = in.drive - sigma2 * in.v;
    return mode.value > 0 ? push : -push;
  }
  S upper(const S& v, Mode mode) const {
    using std::abs;
    return this->level(abs(v), mode.value > 0);
  }
  S lower(const S& v, Mode mode) const {
    return S(2.0) * (mode.value > 0 ? this->Fc : this->Fc_minus) - upper(v, mode);
  }
};

}  // namespace limcycle
