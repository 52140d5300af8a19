#pragma once
#include <numbers>

#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/stick_slip.hpp"

namespace limcycle {

/// Coulomb friction with stiction and viscous part: F = Fc sgn(v) + sigma2 v while sliding, |F| <= Fs at rest.
/// No state; rate-independent for sigma2 = 0; no drift; passive. Coulomb (1785).
template <class S>
struct Coulomb : StickSlip<S, Levels<S>> {
  S sigma2{0.0};

  static constexpr std::string_view kind = "coulomb";
  static constexpr bool piecewise_affine = true;
  static constexpr std::string_view equation =
      "F = Fc sgn(v) + sigma2 v, v != 0;  |F| <= Fs, balancing the drive, v = 0";
  static constexpr std::string_view source = "Coulomb (1785); stiction as in the source thesis eq. 2.3-2.4";
  static constexpr Features features{
      .memory = Memory::none,
      .drifts = false,
      .drift = "none: the body truly sticks while the force on it stays below Fs",
      .rate = "none but the viscous term sigma2 v",
      .passivity = "yes, for sigma2 >= 0: F v = Fc |v| + sigma2 v^2",
      .evidence =
          "read in the source thesis (eq. 2.3, 2.4); the viscous term stands in public code of the 1995 LuGre "
          "example; Coulomb (1785) is quoted from knowledge"};

  static std::vector<Parameter<Coulomb, S>> parameters() {
    auto table = Levels<S>::template levels_table<Coulomb>(false);
    table.push_back({"sigma2", "N s/m", "viscous friction", &Coulomb::sigma2, not_negative, false});
    return table;
  }
  std::optional<BrokenRule> validate() const { return this->validate_levels(); }

  S output(const Input<S>& in, Mode mode, std::span<const S>) const {
    if (mode == this->stuck) return in.drive;
    return (mode == this->forward ? this->Fc : -this->Fc_minus) + sigma2 * in.v;
  }
  /// |F - sigma2 v| <= Fs.
  std::optional<double> force_bound(double speed) const { return this->bound_with_viscous(sigma2, speed); }
  bool odd() const { return this->symmetric(); }
  Scales scales() const { return {.output = value_of(this->Fs)}; }

  /// N = j (4 Fc/(pi A) sqrt(1 - (V/(A w))^2) + sigma2 w) for a mean velocity V below A w; j sigma2 w above. Symmetric
  /// levels only, 4 Fc becoming 2 (Fc + Fc_minus). Gelb and Vander Velde (1968), A2, A3 and A14 of the claims.
  std::optional<std::complex<double>> exact_describing_function(double A, double w,
                                                                double bias) const requires std::same_as<S, double> {
    const double ratio = bias / (A * w);
    const double dry = std::abs(ratio) < 1.0 ? 2.0 * (this->Fc + this->Fc_minus) / (std::numbers::pi * A) *
                                                   std::sqrt((1.0 - ratio) * (1.0 + ratio))
                                             : 0.0;
    return std::complex<double>(0.0, dry + sigma2 * w);
  }
};

}  // namespace limcycle
