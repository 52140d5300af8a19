#pragma once
#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/measured_curve.hpp"
#include "limcycle/models/friction/stick_slip.hpp"

namespace limcycle {

/// Static friction with a curve as it was measured: F = g(v) sgn(v) + sigma2 v while sliding, |F| <= Fs at rest (see
/// MeasuredCurve). No state, no memory, no drift; passive because g > 0.
template <class S>
struct StribeckTable : StickSlip<S, MeasuredCurve<S>> {
  S sigma2{0.0};

  static constexpr std::string_view kind = "stribeck-table";
  static constexpr std::string_view equation =
      "F = g(v) sgn(v) + sigma2 v, v != 0;  |F| <= Fs, balancing the drive, v = 0;  g through (0, Fs) and the points "
      "(velocities, "
      "forces), monotone between them, level beyond the last";
  static constexpr std::string_view source =
      "measured points; interpolation after Fritsch and Butland (1984), SIAM J. Sci. Stat. Comput. 5(2), 300-304, "
      "quoted from knowledge";
  static constexpr Features features{
      .memory = Memory::none,
      .drifts = false,
      .drift = "none: the body truly sticks while the force on it stays below Fs",
      .rate = "the sliding level g(v) and sigma2 v; nothing at rest",
      .passivity = "yes, for sigma2 >= 0: F v = g(v) |v| + sigma2 v^2 with g > 0",
      .evidence =
          "what was measured between its points is assumed to be smooth and monotone; a straight line beyond "
          "the last point is a guess"};

  static std::vector<Parameter<StribeckTable, S>> parameters() {
    auto table = MeasuredCurve<S>::template curve_table<StribeckTable>();
    table.push_back({"sigma2", "N s/m", "viscous friction that the forces do not hold", &StribeckTable::sigma2,
                     not_negative, false});
    return table;
  }
  std::optional<BrokenRule> validate() const { return this->validate_curve(); }

  S output(const Input<S>& in, Mode mode, std::span<const S>) const {
    if (mode == this->stuck) return in.drive;
    using std::abs;
    const S g = this->level(abs(in.v), mode == this->forward);
    return (mode == this->forward ? g : -g) + sigma2 * in.v;
  }
  std::optional<double> force_bound(double speed) const { return this->bound_with_viscous(sigma2, speed); }
  bool odd() const { return this->symmetric(); }
  Scales scales() const { return {.velocity = this->velocity_scale(), .output = value_of(this->Fs)}; }
};

}  // namespace limcycle
