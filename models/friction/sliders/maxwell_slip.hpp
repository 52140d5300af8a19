#pragma once
#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/stop_elements.hpp"

namespace limcycle {

/// Maxwell-slip (Prandtl-Ishlinskii, discrete Iwan) friction: parallel springs k_i, each with a slider that slips at
/// W_i. States: stretches s_i of the springs (m); rate-independent; non-local memory; no drift; passive. The virgin
/// curve is f(x) = sum min(k_i x, W_i), branches after a reversal are F_r -+ 2 f(|x - x_r|/2) (Masing 1926).
template <class S>
struct MaxwellSlip : StopElements<S> {
  static constexpr std::string_view kind = "maxwell-slip";
  static constexpr bool rate_independent = true;
  static constexpr bool piecewise_affine = true;
  static constexpr std::string_view equation =
      "ds_i/dt = v while k_i |s_i| < W_i or moving inwards, else 0;  F = sum k_i s_i";
  static constexpr std::string_view source = "Masing (1926); Iwan (1966), J. Appl. Mech. 33, 893-900; not confirmed";
  static constexpr Features features{
      .memory = Memory::non_local,
      .drifts = false,
      .drift = "none: below sum W the strongest element holds, and a closed cycle of force is a closed path",
      .rate = "none: the force is a function of the path alone",
      .passivity = "yes, with the storage sum k_i s_i^2/2; what is lost is W_i times the distance slipped",
      .evidence =
          "the update of one element was read in public code; the papers are quoted from knowledge, not "
          "confirmed; describing function and Masing's rule were derived and checked numerically"};

  static std::vector<Parameter<MaxwellSlip, S>> parameters() {
    return {{"k", "N/m", "stiffness of each element", &MaxwellSlip::k, positive},
            {"W", "N", "force at which each element slips", &MaxwellSlip::W, positive}};
  }
  std::optional<BrokenRule> validate() const { return this->validate_elements(); }

  void rate(const Input<S>& in, Mode mode, std::span<const S>, std::span<S> ds) const {
    this->stretch_rates(in.v, mode, ds);
  }
  S output(const Input<S>&, Mode, std::span<const S> s) const { return this->elastic_force(s); }

  /// After the limits of all elements, one guard for all that slip: they reverse together.
  int guards(Mode) const { return this->limit_guards() + 1; }
  void guard(const Input<S>& in, Mode mode, std::span<const S> s, std::span<S> g) const {
    this->guard_limits(mode, s, g);
    const int slips = slip_direction(mode);
    g[static_cast<std::size_t>(this->limit_guards())] = slips == 0 ? S(1.0) : slips > 0 ? in.v : -in.v;
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S> s, int fired) const {
    if (fired == this->limit_guards()) return all_sticking(mode);
    return this->slip(mode, s, fired, moves_forward(in, output(in, mode, s)));
  }
  Mode start(const Input<double>&, std::span<double>) const { return {}; }
  /// State and mode after long sliding at in.v.
  Mode after_sliding(const Input<double>& in, std::span<double> s) const {
    for (int i = 0; i < this->states(); ++i) s[static_cast<std::size_t>(i)] = std::copysign(this->state_scale(i), in.v);
    return all_slipping(this->states(), in.v > 0.0);
  }

  static bool is_passive() { return true; }
  std::optional<double> force_bound(double) const { return this->sum_of_limits(); }
  bool odd() const { return true; }
  Mode mirror(Mode mode) const { return mirrored_sliders(mode); }
  Scales scales() const { return {.displacement = this->smallest_yield(), .output = this->sum_of_limits()}; }

  /// Sum of claim A8 over the elements (A9); no closed form for a mean velocity.
  std::optional<std::complex<double>> exact_describing_function(double A, double,
                                                                double bias) const requires std::same_as<S, double> {
    if (bias != 0.0) return std::nullopt;
    std::complex<double> sum;
    for (std::size_t i = 0; i < this->k.size(); ++i) sum += stop_gain(this->k[i], this->W[i], A);
    return sum;
  }
};

}  // namespace limcycle
