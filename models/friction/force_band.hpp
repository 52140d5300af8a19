#pragma once
#include <algorithm>

#include "limcycle/models/friction/levels.hpp"

namespace limcycle {

/// Common part of laws that blend the applied force at rest, within +-Fs, into a sliding level over a band |v| <= dv:
///   F = (1 - weight) sat(Fs; drive) + weight level sgn(v) + sigma2 v,   weight from 0 at v = 0 to 1 at |v| = dv;
/// outside F = g(v) sgn(v) + sigma2 v. At v = 0 the force is balanced up to Fs, so that rest is an exact equilibrium.
///
/// A mode gives the place of the law: outside the band (side +-1), or within it with the drive within +-Fs (load 0) or
/// beyond (load +-1). The body crosses v = 0 only while loaded, and only then the sign of v, `sign`, is part of the
/// mode.
template <class S>
struct ForceBand : StribeckCurve<S>, Memoryless<S> {
  S dv{}, sigma2{0.0};

  static constexpr bool output_needs_rate = true;
  static constexpr bool needs_drive = true;

  /// Mode values: 0 in the band, not loaded; +-1 outside; loaded in the direction of v +-2, against it +-3, by load.
  struct Place {
    int outside = 0;  ///< +-1 outside the band, by the sign of v
    int load = 0;     ///< in the band: +-1 where the drive is beyond +-Fs
    int sign = 0;     ///< of v, while loaded

    static Place of(Mode mode) {
      const auto value = static_cast<int>(mode.value);
      if (value >= -1 && value <= 1) return {value, 0, 0};
      const int size = value < 0 ? -value : value, unit = value < 0 ? -1 : 1;
      return {0, unit, size == 2 ? unit : -unit};
    }
    Mode mode() const { return {load == 0 ? outside : load * (sign == load ? 2 : 3)}; }
  };

  double drive_band() const { return value_of(dv); }
  /// |F - sigma2 v| <= Fs: at rest, at g(v) in slip, and in between.
  std::optional<double> force_bound(double speed) const { return this->bound_with_viscous(sigma2, speed); }

  int guards(Mode mode) const {
    const Place at = Place::of(mode);
    return at.outside != 0 ? 1 : at.load == 0 ? 4 : 3;
  }
  void guard(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> g) const {
    const Place at = Place::of(mode);
    if (at.outside != 0) {
      g[0] = (at.outside > 0 ? in.v : -in.v) - dv;
    } else if (at.load == 0) {
      g[0] = dv - in.v;
      g[1] = dv + in.v;
      g[2] = this->Fs - in.drive;
      g[3] = in.drive + this->Fs_minus;
    } else {
      const S speed = at.sign > 0 ? in.v : -in.v;
      g[0] = dv - speed;
      g[1] = speed;
      g[2] = at.load > 0 ? in.drive - this->Fs : -in.drive - this->Fs_minus;
    }
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S>, int fired) const {
    Place at = Place::of(mode);
    const int side = in.v < 0.0 ? -1 : 1;
    if (at.outside != 0) return within(value_of(in.drive), at.outside);
    if (at.load == 0) {
      if (fired <= 1) return Place{fired == 0 ? 1 : -1, 0, 0}.mode();
      return Place{0, fired == 2 ? 1 : -1, side}.mode();
    }
    if (fired == 0) return Place{at.sign, 0, 0}.mode();
    if (fired == 1) return Place{0, at.load, -at.sign}.mode();
    // A drive without size (see Input::drive) jumps from one side to the other.
    const double drive = value_of(in.drive);
    const bool across = at.load > 0 ? drive < -value_of(this->Fs_minus) : drive > value_of(this->Fs);
    return across ? Place{0, -at.load, at.sign}.mode() : Mode{};
  }
  Mode start(const Input<double>& in, std::span<double>) const {
    const double band = value_of(dv);
    if (in.v > band || in.v < -band) return Place{in.v > 0.0 ? 1 : -1, 0, 0}.mode();
    return within(in.drive, in.v < 0.0 ? -1 : 1);
  }

  bool odd() const { return this->symmetric(); }
  Scales scales() const {
    return {.velocity = std::min(value_of(this->vs), value_of(dv)), .output = value_of(this->Fs)};
  }

 protected:
  /// True if the law is on the side of v >= 0.
  static bool is_forward(const Place& at, const S& v) {
    const int side = at.outside != 0 ? at.outside : at.sign;
    return side != 0 ? side > 0 : !(v < 0.0);
  }
  S sliding(const Place& at, const S& v) const {
    using std::abs;
    return at.outside > 0 ? this->level(abs(v), true) : -this->level(abs(v), false);
  }
  /// sat(Fs; drive), on the part that the mode gives.
  S balanced(const Place& at, const S& drive) const {
    return at.load > 0 ? this->Fs : at.load < 0 ? -this->Fs_minus : drive;
  }

 private:
  Mode within(double drive, int side) const {
    const int load = drive > value_of(this->Fs) ? 1 : drive < -value_of(this->Fs_minus) ? -1 : 0;
    return Place{0, load, load == 0 ? 0 : side}.mode();
  }
};

}  // namespace limcycle
