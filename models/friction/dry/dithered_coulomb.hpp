#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/levels.hpp"

namespace limcycle {

/// Mean of Coulomb friction over a fast vibration v + speed sin(theta) of the rubbing velocity, as dither causes it:
///   F = (Fc + Fc_minus)/pi asin(v/speed) + (Fc - Fc_minus)/2,  |v| < speed;  F = Fc sgn(v) beyond;  plus sigma2 v.
/// So friction that holds a body becomes viscous friction of 2 Fc/(pi speed) about v = 0, and stiction is gone: the
/// body is at rest at instants only. No case names this law: it takes the place of Coulomb's in a loop under dither. No
/// state, and no modes: F is continuous, its slope infinite at |v| = speed.
template <class S>
struct DitheredCoulomb : Memoryless<S> {
  S Fc{}, Fc_minus{}, speed{}, sigma2{0.0};

  static constexpr std::string_view kind = "dithered-coulomb";
  static constexpr bool uses_rate = true;
  static constexpr bool output_needs_rate = true;
  static constexpr std::string_view equation =
      "F = 2 Fc/pi asin(v/speed) + sigma2 v, |v| < speed;  F = Fc sgn(v) + sigma2 v beyond";
  static constexpr std::string_view source = "the mean of sgn(v + speed sin theta) over theta: textbook";
  static constexpr Features features{.memory = Memory::none,
                                     .drifts = true,
                                     .drift = "at any force, however small: there is no stiction",
                                     .rate = "as viscous friction below the speed of the vibration",
                                     .passivity = "yes for equal levels: F v >= 0",
                                     .evidence = "the mean is tested against quadrature"};

  static std::vector<Parameter<DitheredCoulomb, S>> parameters() {
    return {{"Fc", "N", "sliding (Coulomb) level", &DitheredCoulomb::Fc, positive},
            {"speed", "m/s", "amplitude of the vibration's velocity", &DitheredCoulomb::speed, positive},
            {"Fc_minus", "N", "sliding level for v < 0", &DitheredCoulomb::Fc_minus, positive, false, "Fc"},
            {"sigma2", "N s/m", "viscous friction", &DitheredCoulomb::sigma2, not_negative, false}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  S output(const Input<S>& in, Mode, std::span<const S>) const {
    const S viscous = sigma2 * in.v;
    const S share = in.v / speed;
    const double at = std::clamp(value_of(share), -1.0, 1.0);
    const double slope = std::abs(at) < 1.0 ? 1.0 / std::sqrt((1.0 - at) * (1.0 + at)) : 0.0;
    const S angle = S(std::asin(at)) + slope * (share - S(value_of(share)));  // with its derivative
    return (Fc + Fc_minus) * angle / std::numbers::pi + 0.5 * (Fc - Fc_minus) + viscous;
  }

  bool odd() const { return Fc == Fc_minus; }
  Scales scales() const { return {.velocity = value_of(speed), .output = std::max(value_of(Fc), value_of(Fc_minus))}; }
};

}  // namespace limcycle
