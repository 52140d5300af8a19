#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Break-away level Fs and sliding level Fc of dry friction, N, with separate values for motion in the negative
/// direction (`Fs_minus`, `Fc_minus`, by default the same).
template <class S>
struct Levels {
  S Fs{}, Fc{}, Fs_minus{}, Fc_minus{};

  bool symmetric() const { return Fs == Fs_minus && Fc == Fc_minus; }

  double highest_level() const { return std::max(value_of(Fs), value_of(Fs_minus)); }
  double lowest_level() const { return std::min(value_of(Fc), value_of(Fc_minus)); }
  /// Bound of |F| for a law with |F - sigma2 v| <= Fs at speeds up to `speed`.
  double bound_with_viscous(const S& sigma2, double speed) const {
    return highest_level() + (sigma2 > 0.0 ? value_of(sigma2) * speed : 0.0);
  }

  template <class Owner>
  static std::vector<Parameter<Owner, S>> levels_table(bool Fs_required) {
    return {{"Fc", "N", "sliding (Coulomb) level", &Owner::Fc, positive},
            {"Fs", "N", "break-away (stiction) level", &Owner::Fs, positive, Fs_required, Fs_required ? "" : "Fc"},
            {"Fc_minus", "N", "sliding level for v < 0", &Owner::Fc_minus, positive, false, "Fc"},
            {"Fs_minus", "N", "break-away level for v < 0", &Owner::Fs_minus, positive, false, "Fs"}};
  }

  std::optional<BrokenRule> validate_levels() const {
    if (Fs < Fc) return BrokenRule{"Fs", "must be at least Fc"};
    if (Fs_minus < Fc_minus) return BrokenRule{"Fs_minus", "must be at least Fc_minus"};
    return std::nullopt;
  }
};

/// Levels joined by a Stribeck curve g(v) > 0, N:
///   exponential  g = Fc + (Fs - Fc) exp(-|v/vs|^delta)   (Bo and Pavelescu 1982; delta = 2 is the Gaussian form)
///   tustin       the same with delta = 1                  (Tustin 1947)
///   lorentzian   g = Fc + (Fs - Fc) / (1 + |v/vs|^delta)
/// Fc <= g <= Fs for every v. The published forms of Tustin and Bo-Pavelescu are quoted from memory, not confirmed.
template <class S>
struct StribeckCurve : Levels<S> {
  S vs{}, delta{2.0};
  Choice curve{};
  static constexpr std::string_view curves[] = {"exponential", "tustin", "lorentzian"};

  /// g(v), N. v = 0 counts as v >= 0.
  S level(const S& v) const {
    using std::abs;
    return level_between(abs(v), select(v < 0.0, this->Fs_minus, this->Fs), select(v < 0.0, this->Fc_minus, this->Fc));
  }
  /// g at a speed >= 0 in a given direction, also for v = 0.
  S level(const S& speed, bool forward) const {
    return forward ? level_between(speed, this->Fs, this->Fc) : level_between(speed, this->Fs_minus, this->Fc_minus);
  }

  double velocity_scale() const { return value_of(vs); }
  std::optional<BrokenRule> validate_curve() const { return this->validate_levels(); }

  /// Power of |v| with which g leaves its value at v = 0, 1 at most.
  double steep_exponent() const {
    constexpr int tustin = 1;  // Tustin's curve has delta = 1, whatever the value of delta
    return curve.index == tustin ? 1.0 : std::min(value_of(delta), 1.0);
  }

  template <class Owner>
  static std::vector<Parameter<Owner, S>> stribeck_table() {
    auto table = Levels<S>::template levels_table<Owner>(true);
    table.push_back({"vs", "m/s", "Stribeck velocity", &Owner::vs, positive});
    table.push_back({"delta", "1", "Stribeck exponent", &Owner::delta, positive, false});
    table.push_back({"curve", "1", "shape of the Stribeck curve", &Owner::curve, any_number, false, "", curves});
    return table;
  }

 private:
  S level_between(const S& speed, const S& fs, const S& fc) const {
    const S ratio = speed / vs;
    switch (curve.index) {
      case 1:
        return fallen(fs, fc, ratio);
      case 2:
        return fc + (fs - fc) / (S(1.0) + power(ratio, delta));
      default:
        return fallen(fs, fc, power(ratio, delta));
    }
  }
  /// fc + (fs - fc) exp(-x), x >= 0. exp() is not called where it underflows to zero: it is slowest there.
  static S fallen(const S& fs, const S& fc, const S& x) {
    using std::exp;
    constexpr double underflows = 746.0;
    return x > underflows ? fc : fc + (fs - fc) * exp(-x);
  }
};

}  // namespace limcycle
