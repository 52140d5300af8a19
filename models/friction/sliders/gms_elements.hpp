#pragma once
#include "limcycle/models/friction/stop_elements.hpp"

namespace limcycle {

/// The elements of generalised Maxwell-slip friction over any curve of the sliding level g(v) > 0, which `Curve` offers
/// as `level`:
///   stick  dF_i/dt = k_i v                                    until |F_i| = alpha_i g(v)
///   slip   dF_i/dt = C (sgn(v) alpha_i - F_i/g(v))            until v changes sign
///   F = sum F_i + sum (sigma1_i/k_i) dF_i/dt + sigma2 v.
/// An element that sticks while g falls below its |F_i|/alpha_i slips at once, in whichever direction it is stretched.
/// The deflection damped by sigma1_i is F_i/k_i, in slip too. C (N/s) sets the lag g/C behind the curve; a list of C_i
/// elsewhere means C_i = alpha_i C. |F_i| <= alpha_i max g is invariant.
template <class S, class Curve>
struct GmsElements : Curve {
  std::vector<S> k, alpha, sigma1;
  S C{}, sigma2{0.0};

  static constexpr bool output_needs_rate = true;

  template <class Owner>
  static void append_elements(std::vector<Parameter<Owner, S>>& table) {
    table.push_back({"k", "N/m", "stiffness of each element", &Owner::k, positive});
    table.push_back({"alpha", "1", "share of each element in the level; the sum is 1", &Owner::alpha, positive});
    table.push_back({"C", "N/s", "attraction to the Stribeck curve in slip", &Owner::C, positive});
    table.push_back({"sigma1", "N s/m", "damping of each element", &Owner::sigma1, not_negative, false});
    table.push_back({"sigma2", "N s/m", "viscous friction", &Owner::sigma2, not_negative, false});
  }

  std::optional<BrokenRule> validate() const {
    if (auto broken = this->validate_curve()) return broken;
    if (auto broken = validate_sliders("k", k, "alpha", alpha)) return broken;
    if (!sigma1.empty())
      if (auto broken = validate_sliders("k", k, "sigma1", sigma1)) return broken;
    double sum = 0.0;
    for (const S& share : alpha) sum += value_of(share);
    if (!(std::abs(sum - 1.0) <= 1e-6)) return BrokenRule{"alpha", "must sum to 1, sums to " + std::to_string(sum)};
    return std::nullopt;
  }

  int states() const { return static_cast<int>(k.size()); }
  void rate(const Input<S>& in, Mode mode, std::span<const S> F, std::span<S> dF) const {
    const S g = level_in(in, mode);
    for (std::size_t i = 0; i < k.size(); ++i) dF[i] = force_rate(i, in, mode, g, F[i]);
  }
  S output(const Input<S>& in, Mode mode, std::span<const S> F) const {
    S sum = sigma2 * in.v;
    for (std::size_t i = 0; i < k.size(); ++i) sum += F[i];
    if (sigma1.empty()) return sum;
    const S g = level_in(in, mode);
    for (std::size_t i = 0; i < k.size(); ++i) sum += sigma1[i] / k[i] * force_rate(i, in, mode, g, F[i]);
    return sum;
  }

  /// Energy in the springs, sum F_i^2/(2 k_i). It rises without work while a slipping element creeps (Fs > Fc).
  S storage(Mode, std::span<const S> F) const {
    S sum(0.0);
    for (std::size_t i = 0; i < k.size(); ++i) sum += 0.5 * F[i] * F[i] / k[i];
    return sum;
  }

  /// Two guards an element, force left before it slips stretched forwards and backwards (N), and one for all that slip.
  int guards(Mode) const { return 2 * states() + 1; }
  void guard(const Input<S>& in, Mode mode, std::span<const S> F, std::span<S> g) const {
    const S level = this->level(in.v);
    for (std::size_t i = 0; i < k.size(); ++i) {
      const S limit = alpha[i] * level;
      const bool sticks = slider(mode, static_cast<int>(i)) == Slider::sticks;
      g[2 * i] = sticks ? without_roundings(limit - F[i], value_of(limit)) : limit;
      g[2 * i + 1] = sticks ? without_roundings(limit + F[i], value_of(limit)) : limit;
    }
    const int slips = slip_direction(mode);
    g[2 * k.size()] = slips == 0 ? S(1.0) : (slips > 0 ? in.v : -in.v) + S(reversal_band());
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S> F, int fired) const {
    if (fired == 2 * states()) return all_sticking(mode);
    const bool forward = drifts_forward(in, mode, F);
    // An element driven over its limit is set exactly on it: an excess left by event location would count as stretched
    // too far when the motion reverses.
    const auto i = static_cast<std::size_t>(fired / 2);
    const S limit = (forward ? alpha[i] : -alpha[i]) * this->level(in.v);
    const double beyond = value_of(F[i] - limit);  // subtracted as a number: derivatives with respect to F_i are kept
    if (std::abs(beyond) <= 10.0 * slider_slack * value_of(this->Fs)) F[i] = F[i] - S(beyond);
    return with_slider(mode, fired / 2, forward ? Slider::slips_forward : Slider::slips_backward);
  }
  Mode start(const Input<double>&, std::span<double>) const { return {}; }
  /// State and mode after long sliding at in.v.
  Mode after_sliding(const Input<double>& in, std::span<double> F) const {
    const double level = std::copysign(value_of(this->level(S(in.v))), in.v);
    for (std::size_t i = 0; i < k.size(); ++i) F[i] = value_of(alpha[i]) * level;
    return all_slipping(states(), in.v > 0.0);
  }

  /// |F_i| <= alpha_i Fs; |dF_i/dt| <= k_i |v| in stick and C alpha_i (1 + Fs/Fc) in slip.
  std::optional<double> force_bound(double speed) const {
    const double ratio = 1.0 + this->highest_level() / this->lowest_level();
    double sum = this->bound_with_viscous(sigma2, speed);
    for (std::size_t i = 0; i < sigma1.size(); ++i)
      if (sigma1[i] > 0.0)
        sum += value_of(sigma1[i] / k[i]) * std::max(value_of(k[i]) * speed, value_of(C * alpha[i]) * ratio);
    return sum;
  }
  std::vector<std::pair<double, double>> state_bounds() const {
    std::vector<std::pair<double, double>> bounds;
    bounds.reserve(alpha.size());
    for (const S& share : alpha) {
      const double most = value_of(share) * this->highest_level();
      bounds.emplace_back(-most, most);
    }
    return bounds;
  }
  bool odd() const { return this->symmetric(); }
  Mode mirror(Mode mode) const { return mirrored_sliders(mode); }
  Scales scales() const {
    double smallest = infinite;
    for (std::size_t i = 0; i < k.size(); ++i) smallest = std::min(smallest, value_of(alpha[i] * this->Fs / k[i]));
    return {.displacement = smallest, .velocity = this->velocity_scale(), .output = value_of(this->Fs)};
  }
  double state_scale(int i) const { return value_of(alpha[static_cast<std::size_t>(i)] * this->Fs); }

 private:
  /// Level for the direction of slip: v itself may be a rounding error away from zero.
  S level_in(const Input<S>& in, Mode mode) const {
    using std::abs;
    return this->level(abs(in.v), slip_direction(mode) >= 0);
  }
  S force_rate(std::size_t i, const Input<S>& in, Mode mode, const S& g, const S& F) const {
    const Slider now = slider(mode, static_cast<int>(i));
    if (now == Slider::sticks) return k[i] * in.v;
    return C * ((now == Slider::slips_forward ? alpha[i] : -alpha[i]) - F / g);
  }

  /// If the levels jump at v = 0, slip ends only this far beyond it: an element that the jump leaves above its new
  /// limit slips in the new direction, and must not count as reversing because v is still a rounding away from 0.
  double reversal_band() const { return this->symmetric() ? 0.0 : 1e-12 * this->velocity_scale(); }

  bool drifts_forward(const Input<S>& in, Mode mode, std::span<const S> F) const {
    const double band = reversal_band();
    if (in.v > band) return true;
    if (in.v < -band) return false;
    return in.drive > output(in, mode, F);
  }
};

}  // namespace limcycle
