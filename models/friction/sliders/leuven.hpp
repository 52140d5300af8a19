#pragma once
#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/levels.hpp"
#include "limcycle/models/friction/stop_elements.hpp"

namespace limcycle {

/// Leuven friction in its modified form (Swevers, Al-Bender, Ganseman, Prajogo 2000; Lampaert, Swevers, Al-Bender
/// 2002):
///   dz/dt = v (1 - sgn(F_h/s(v)) |F_h/s(v)|^n),  s(v) = sgn(v) g(v),  F = F_h + sigma1 dz/dt + sigma2 v,
/// F_h being the force of Maxwell-slip elements k_i, W_i driven by z. States: stretches of their springs (m); z itself
/// is not needed. Non-local memory in pre-sliding; drifts, less for larger n; rate-dependent through g and sigma1.
/// Steady sliding reaches g(v) only if sum W >= Fs. With one element that never slips and n = 1 it is LuGre.
template <class S>
struct Leuven : StribeckCurve<S>, StopElements<S> {
  S n{1.0}, sigma1{0.0}, sigma2{0.0};

  static constexpr std::string_view kind = "leuven";
  static constexpr bool output_needs_rate = true;
  static constexpr std::string_view equation =
      "dz/dt = v (1 - sgn(F_h/s) |F_h/s|^n), s = sgn(v) g(v);  F = F_h + sigma1 dz/dt + sigma2 v;  F_h = sum k_i s_i, "
      "ds_i/dt = dz/dt while k_i |s_i| < W_i or moving inwards, else 0;  g = Fc + (Fs - Fc) exp(-|v/vs|^delta)";
  static constexpr std::string_view source =
      "Swevers, Al-Bender, Ganseman, Prajogo (2000), IEEE TAC 45(4), 675-686; Lampaert, Swevers, Al-Bender (2002), "
      "IEEE "
      "TAC 47(4), 683-687; equations not confirmed";
  static constexpr Features features{
      .memory = Memory::non_local,
      .drifts = true,
      .drift = "ratchets under a biased periodic force, the less the larger n",
      .rate =
          "in pre-sliding sigma1; in sliding the level g(v), which is followed with a lag over a distance, and sigma2 "
          "v",
      .passivity =
          "if sigma2/sigma1 >= (Fs/Fc)^n - 1 (in each direction), so for sigma1 = 0, with the storage sum k_i s_i^2/2: "
          "what is lost is |F_h v| |F_h/g|^n and W_i times the distance slipped, and dz/dt >= -v ((Fs/Fc)^n - 1); for "
          "less, at unbounded speed, not: slide slowly, then step to a high speed",
      .evidence =
          "the abstract of 2002 was read (Maxwell-slip elements, a modified state equation); both equations are "
          "quoted from knowledge, not confirmed; s(v) must be odd"};

  static std::vector<Parameter<Leuven, S>> parameters() {
    auto table = StribeckCurve<S>::template stribeck_table<Leuven>();
    table.push_back({"k", "N/m", "stiffness of each element", &Leuven::k, positive});
    table.push_back({"W", "N", "force at which each element slips", &Leuven::W, positive});
    table.push_back({"n", "1", "sharpness of the transition to sliding", &Leuven::n, positive, false});
    table.push_back({"sigma1", "N s/m", "damping of the deflection", &Leuven::sigma1, not_negative, false});
    table.push_back({"sigma2", "N s/m", "viscous friction", &Leuven::sigma2, not_negative, false});
    return table;
  }
  std::optional<BrokenRule> validate() const {
    if (auto broken = this->validate_levels()) return broken;
    if (auto broken = this->validate_elements()) return broken;
    const double sum = this->sum_of_limits();
    for (const auto& [key, level] : {std::pair{"Fs", this->Fs}, {"Fs_minus", this->Fs_minus}})
      if (sum < value_of(level) * (1.0 - 1e-9))
        return BrokenRule{"W", std::string("must sum to ") + key + " or more; it sums to " + std::to_string(sum)};
    return std::nullopt;
  }

  void rate(const Input<S>& in, Mode mode, std::span<const S> s, std::span<S> ds) const {
    this->stretch_rates(deflection_rate(in, s), mode, ds);
  }
  S output(const Input<S>& in, Mode, std::span<const S> s) const {
    return this->elastic_force(s) + sigma1 * deflection_rate(in, s) + sigma2 * in.v;
  }

  /// After the limits of all elements: the reversal of dz/dt for all that slip (with v, or F_h above a falling level),
  /// and the sign of F_h if its power has a kink at zero.
  int guards(Mode) const { return this->limit_guards() + 2; }
  void guard(const Input<S>& in, Mode mode, std::span<const S> s, std::span<S> g) const {
    using std::abs;
    this->guard_limits(mode, s, g);
    const auto turn = static_cast<std::size_t>(this->limit_guards());
    const int slips = slip_direction(mode);
    const S dz = deflection_rate(in, s);
    // In steady sliding dz/dt is 0 up to rounding, which must not count as a reversal.
    g[turn] = slips == 0 ? S(1.0) : without_roundings(slips > 0 ? dz : -dz, std::abs(value_of(in.v)));
    const S force = this->elastic_force(s);
    g[turn + 1] = smooth() ? S(1.0) : (mode.value & pulls_back) != 0 ? -force : force;
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S> s, int fired) const {
    if (fired == this->limit_guards()) return all_sticking(mode);
    if (fired == this->limit_guards() + 1) return {mode.value ^ pulls_back};
    const Input<S> driven{in.x, deflection_rate(in, s), in.drive};
    return this->slip(mode, s, fired, moves_forward(driven, output(in, mode, s)));
  }
  Mode start(const Input<double>& in, std::span<double> s) const {
    double force = 0.0;
    for (std::size_t i = 0; i < this->k.size(); ++i) force += value_of(this->k[i]) * s[i];
    const bool back = force < 0.0 || (force == 0.0 && in.v < 0.0);
    return {!smooth() && back ? pulls_back : 0};
  }

  /// State and mode after long sliding at in.v from rest: the elements stretched equally until their force is g.
  Mode after_sliding(const Input<double>& in, std::span<double> s) const {
    const double level = std::min(value_of(this->level(S(in.v))), this->sum_of_limits());
    double low = 0.0, high = 0.0;
    for (int i = 0; i < this->states(); ++i) high = std::max(high, this->state_scale(i));
    while (0.5 * (low + high) > low && 0.5 * (low + high) < high) {
      double force = 0.0;
      const double stretch = 0.5 * (low + high);
      for (int i = 0; i < this->states(); ++i)
        force += value_of(this->k[static_cast<std::size_t>(i)]) * std::min(stretch, this->state_scale(i));
      (force < level ? low : high) = stretch;
    }
    const bool forward = in.v > 0.0;
    Mode mode{smooth() || forward ? 0 : pulls_back};
    for (int i = 0; i < this->states(); ++i) {
      s[static_cast<std::size_t>(i)] = std::copysign(std::min(high, this->state_scale(i)), in.v);
      if (high >= this->state_scale(i))
        mode = with_slider(mode, i, forward ? Slider::slips_forward : Slider::slips_backward);
    }
    return mode;
  }

  bool is_passive() const {
    const double least = std::pow(this->highest_level() / this->lowest_level(), value_of(n)) - 1.0;
    return value_of(sigma2) >= value_of(sigma1) * least;
  }
  /// |F_h| <= Fs, as dz/dt reverses there, so that |dz/dt| <= |v| (1 + (Fs/Fc)^n).
  std::optional<double> force_bound(double speed) const {
    const double most = this->highest_level(), least = this->lowest_level();
    const double pull = sigma1 > 0.0 ? value_of(sigma1) * speed * (1.0 + std::pow(most / least, value_of(n))) : 0.0;
    return std::min(most, this->sum_of_limits()) + pull + (sigma2 > 0.0 ? value_of(sigma2) * speed : 0.0);
  }
  bool odd() const { return this->symmetric(); }
  Mode mirror(Mode mode) const { return {mirrored_sliders(mode).value ^ (smooth() ? 0 : pulls_back)}; }
  Scales scales() const {
    return {.displacement = this->smallest_yield(), .velocity = value_of(this->vs), .output = value_of(this->Fs)};
  }

 private:
  static constexpr std::int64_t pulls_back = std::int64_t{1} << 62;  ///< mode bit: F_h is negative

  /// True if sgn(F) |F|^n has no kink at 0.
  bool smooth() const { return std::fmod(value_of(n), 2.0) == 1.0; }

  S deflection_rate(const Input<S>& in, std::span<const S> s) const {
    using std::abs;
    const S ratio = sign(in.v) * this->elastic_force(s) / this->level(in.v);
    return in.v * (S(1.0) - sign(ratio) * power(abs(ratio), n));
  }
};

}  // namespace limcycle
