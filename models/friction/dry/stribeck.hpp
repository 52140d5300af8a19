#pragma once
#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/stick_slip.hpp"

namespace limcycle {

/// Static friction with a Stribeck curve: F = g(v) sgn(v) + sigma2 v while sliding, |F| <= Fs at rest.
/// No state, no memory, no drift; passive because g > 0.
template <class S>
struct Stribeck : StickSlip<S, StribeckCurve<S>> {
  S sigma2{0.0};

  static constexpr std::string_view kind = "stribeck";
  static constexpr std::string_view equation =
      "F = g(v) sgn(v) + sigma2 v, v != 0;  |F| <= Fs, balancing the drive, v = 0;  g = Fc + (Fs - Fc) "
      "exp(-|v/vs|^delta)";
  static constexpr std::string_view source =
      "Stribeck (1902); exponential curve after Bo and Pavelescu (1982), not confirmed";
  static constexpr Features features{
      .memory = Memory::none,
      .drifts = false,
      .drift = "none: the body truly sticks while the force on it stays below Fs",
      .rate = "the sliding level g(v) and sigma2 v; nothing at rest",
      .passivity = "yes, for sigma2 >= 0: F v = g(v) |v| + sigma2 v^2 with g > 0",
      .evidence =
          "exponential curve with delta = 2 read in the source documents, the Lorentzian one in public code; "
          "Tustin's curve and other exponents (0.5 to 2 are used) are quoted from knowledge, not confirmed"};

  static std::vector<Parameter<Stribeck, S>> parameters() {
    auto table = StribeckCurve<S>::template stribeck_table<Stribeck>();
    table.push_back({"sigma2", "N s/m", "viscous friction", &Stribeck::sigma2, not_negative, false});
    return table;
  }
  std::optional<BrokenRule> validate() const { return this->validate_levels(); }

  S output(const Input<S>& in, Mode mode, std::span<const S>) const {
    if (mode == this->stuck) return in.drive;
    // The mode, not the sign of v, selects the side: v itself may be a rounding error away from zero.
    using std::abs;
    const S g = this->level(abs(in.v), mode == this->forward);
    return (mode == this->forward ? g : -g) + sigma2 * in.v;
  }
  /// |F - sigma2 v| <= Fs: at rest, and at g(v) in slip.
  std::optional<double> force_bound(double speed) const { return this->bound_with_viscous(sigma2, speed); }
  bool odd() const { return this->symmetric(); }
  Scales scales() const { return {.velocity = value_of(this->vs), .output = value_of(this->Fs)}; }
};

}  // namespace limcycle
