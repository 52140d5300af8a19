#pragma once
#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/stop_elements.hpp"

namespace limcycle {

/// Jenkins element (stop operator, elastic-perfectly plastic): a spring k in series with a slider that slips at Fc.
/// State: stretch s of the spring (m). One state and a mode; rate-independent; a closed minor loop leaves no trace as
/// long as the slider does not slip; no drift; passive with the storage k s^2/2. Prandtl (1928), Jenkins (1962).
template <class S>
struct Jenkins {
  S k{}, Fc{};

  static constexpr std::string_view kind = "jenkins";
  static constexpr bool is_one_state = true;
  static constexpr bool rate_independent = true;
  static constexpr bool piecewise_affine = true;
  static constexpr std::string_view equation = "ds/dt = v while k |s| < Fc or moving inwards, else 0;  F = k s";
  static constexpr std::string_view source = "Prandtl (1928); Jenkins (1962); not confirmed";
  static constexpr Features features{
      .memory = Memory::local,
      .drifts = false,
      .drift = "none: below Fc the spring holds, and a closed cycle of force is a closed path",
      .rate = "none: the force is a function of the path alone",
      .passivity = "yes, with the storage k s^2/2; what is lost is Fc times the distance slipped",
      .evidence =
          "the stop operator was read in public code; the papers are quoted from knowledge, not confirmed; the "
          "describing function was derived and checked numerically"};

  static std::vector<Parameter<Jenkins, S>> parameters() {
    return {{"k", "N/m", "stiffness", &Jenkins::k, positive},
            {"Fc", "N", "force at which it slips", &Jenkins::Fc, positive}};
  }
  std::optional<BrokenRule> validate() const { return std::nullopt; }

  int states() const { return 1; }
  void rate(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> ds) const {
    ds[0] = slider(mode, 0) == Slider::sticks ? in.v : S(0.0);
  }
  S output(const Input<S>&, Mode, std::span<const S> s) const { return k * s[0]; }

  S storage(Mode, std::span<const S> s) const { return 0.5 * k * s[0] * s[0]; }

  /// Sticking: force left before it slips, forwards and backwards. Slipping: the rate in the direction of slip.
  int guards(Mode mode) const { return slip_direction(mode) == 0 ? 2 : 1; }
  void guard(const Input<S>& in, Mode mode, std::span<const S> s, std::span<S> g) const {
    const int slips = slip_direction(mode);
    if (slips != 0) {
      g[0] = slips > 0 ? in.v : -in.v;
      return;
    }
    const S limit = Fc / k;
    g[0] = k * without_roundings(limit - s[0], value_of(limit));
    g[1] = k * without_roundings(limit + s[0], value_of(limit));
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S> s, int fired) const {
    if (slip_direction(mode) != 0) return all_sticking(mode);
    const bool driven_forward = moves_forward(in, output(in, mode, s)), forward = fired == 0;
    s[0] = (forward ? Fc : -Fc) / k;
    if (forward != driven_forward) return mode;  // a trial state beyond the limit
    return with_slider(mode, 0, forward ? Slider::slips_forward : Slider::slips_backward);
  }
  Mode start(const Input<double>&, std::span<double>) const { return {}; }
  /// State and mode after long sliding at in.v.
  Mode after_sliding(const Input<double>& in, std::span<double> s) const {
    s[0] = std::copysign(value_of(Fc / k), in.v);
    return all_slipping(1, in.v > 0.0);
  }

  static bool is_passive() { return true; }
  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return mirrored_sliders(mode); }
  Scales scales() const { return {.displacement = value_of(Fc / k), .output = value_of(Fc)}; }
  double state_scale(int) const { return value_of(Fc / k); }

  /// Claim A8; no closed form for a mean velocity.
  std::optional<std::complex<double>> exact_describing_function(double A, double,
                                                                double bias) const requires std::same_as<S, double> {
    if (bias != 0.0) return std::nullopt;
    return stop_gain(k, Fc, A);
  }
};

}  // namespace limcycle
