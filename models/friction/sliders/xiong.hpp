#pragma once
#include <algorithm>
#include <cmath>

#include "limcycle/models/friction/features.hpp"
#include "limcycle/models/friction/levels.hpp"

namespace limcycle {

/// The multistate friction of Xiong, Kikuuwe and Yamamoto: N elements in parallel, each a spring K_i and a damper
/// sigma_i whose force is capped by its share lambda_i of a level b that follows the Stribeck curve with the lag tau:
///   tau db/dt = g(v) - b,   f_i = sat(lambda_i b; K_i a_i + sigma_i v),   da_i/dt = (f_i - K_i a_i)/sigma_i,
///   F = sum f_i + sigma2 v.
/// N + 1 states: the deflections a_i (m), then b (N; Fs without history). Modes: two bits an element, 0 below its cap
/// (then da_i/dt = v), 1 and 2 at the upper and lower cap. Non-local memory; no drift; passive; always continuous.
/// Xiong, Kikuuwe, Yamamoto (2013), Tribology Letters 51(3), 513-523.
template <class S>
struct Xiong : StribeckCurve<S> {
  std::vector<S> K, sigma, lambda;
  S tau{}, sigma2{0.0};

  static constexpr int most_elements = 31;  ///< two bits each in a mode
  static constexpr bool output_needs_rate = true;
  static constexpr std::string_view kind = "xiong";
  static constexpr std::string_view equation =
      "tau db/dt = g(v) - b;  f_i = sat(lambda_i b; K_i a_i + sigma_i v);  da_i/dt = (f_i - K_i a_i)/sigma_i;  F = sum "
      "f_i + sigma2 v;  g = Fc + (Fs - Fc) exp(-|v/vs|^delta)";
  static constexpr std::string_view source =
      "Xiong, Kikuuwe, Yamamoto (2013), Tribology Letters 51(3), 513-523; form derived, not read";
  static constexpr Features features{
      .memory = Memory::non_local,
      .drifts = false,
      .drift = "none: below sum lambda_i b = b no element slips for good",
      .rate = "the dampers sigma_i before sliding, the lag tau of the level in sliding, and sigma2 v",
      .passivity = "yes, for positive parameters: storage sum K_i a_i^2/2, element by element",
      .evidence =
          "the printed equations were not available: derived from the structure that the abstracts state "
          "(parallel single-state elements, a lag tau, continuous equations). Whether g is taken at the velocity "
          "or at the slip rate was not confirmed"};

  static std::vector<Parameter<Xiong, S>> parameters() {
    auto table = StribeckCurve<S>::template stribeck_table<Xiong>();
    table.push_back({"K", "N/m", "stiffness of each element", &Xiong::K, positive});
    table.push_back({"sigma", "N s/m", "damping of each element", &Xiong::sigma, positive});
    table.push_back({"lambda", "1", "share of the level of each element; sum 1", &Xiong::lambda, positive});
    table.push_back({"tau", "s", "lag of the level", &Xiong::tau, positive});
    table.push_back({"sigma2", "N s/m", "viscous friction", &Xiong::sigma2, not_negative, false});
    return table;
  }
  std::optional<BrokenRule> validate() const {
    if (auto broken = this->validate_levels()) return broken;
    if (K.empty()) return BrokenRule{"K", "must have at least one element"};
    if (K.size() > most_elements) return BrokenRule{"K", "must have at most 31 elements"};
    if (sigma.size() != K.size()) return BrokenRule{"sigma", "must have as many elements as K"};
    if (lambda.size() != K.size()) return BrokenRule{"lambda", "must have as many elements as K"};
    double sum = 0.0;
    for (std::size_t i = 0; i < K.size(); ++i) {
      if (!(value_of(K[i]) > 0.0)) return BrokenRule{"K", "must have positive elements"};
      if (!(value_of(sigma[i]) > 0.0)) return BrokenRule{"sigma", "must have positive elements"};
      if (!(value_of(lambda[i]) > 0.0)) return BrokenRule{"lambda", "must have positive elements"};
      sum += value_of(lambda[i]);
    }
    if (!(std::abs(sum - 1.0) <= 1e-6)) return BrokenRule{"lambda", "must add up to 1 within 1e-6"};
    return std::nullopt;
  }

  int states() const { return static_cast<int>(K.size()) + 1; }
  void rate(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const {
    const std::size_t n = K.size();
    for (std::size_t i = 0; i < n; ++i) {
      const S cap = lambda[i] * z[n];
      switch (code(mode, i)) {
        case 0:
          dz[i] = in.v;
          break;
        case 1:
          dz[i] = (cap - K[i] * z[i]) / sigma[i];
          break;
        default:
          dz[i] = (-cap - K[i] * z[i]) / sigma[i];
      }
    }
    dz[n] = (this->level(in.v) - z[n]) / tau;
  }
  S output(const Input<S>& in, Mode mode, std::span<const S> z) const {
    const std::size_t n = K.size();
    S sum = sigma2 * in.v;
    for (std::size_t i = 0; i < n; ++i) {
      const int where = code(mode, i);
      sum = sum + (where == 0 ? trial(in, z, i) : where == 1 ? lambda[i] * z[n] : -(lambda[i] * z[n]));
    }
    return sum;
  }

  /// Energy in the springs, sum K_i a_i^2/2.
  S storage(Mode, std::span<const S> z) const {
    S sum(0.0);
    for (std::size_t i = 0; i < K.size(); ++i) sum = sum + 0.5 * K[i] * z[i] * z[i];
    return sum;
  }

  /// Below the cap: the distances from both caps, element by element; at a cap: the excess of the trial force over it.
  /// The modes overlap, so that an element that comes to rest at its cap stays in one mode.
  int guards(Mode mode) const {
    int count = 0;
    for (std::size_t i = 0; i < K.size(); ++i) count += code(mode, i) == 0 ? 2 : 1;
    return count;
  }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
    std::size_t at = 0;
    for (std::size_t i = 0; i < K.size(); ++i) {
      const S force = trial(in, z, i), cap = lambda[i] * z[K.size()];
      const S above = S(1.0 + overlap) * cap, below = S(1.0 - overlap) * cap;
      switch (code(mode, i)) {
        case 0:
          g[at++] = above - force;
          g[at++] = above + force;
          break;
        case 1:
          g[at++] = force - below;
          break;
        default:
          g[at++] = -force - below;
      }
    }
  }
  Mode next(const Input<S>&, Mode mode, std::span<S>, int fired) const {
    int at = 0;
    for (std::size_t i = 0; i < K.size(); ++i) {
      const int where = code(mode, i), count = where == 0 ? 2 : 1;
      if (fired < at + count) return with(mode, i, where != 0 ? 0 : fired == at ? 1 : 2);
      at += count;
    }
    return mode;
  }
  /// No deflection, the level at Fs; an element with damping only may be at its cap.
  Mode start(const Input<double>& in, std::span<double> z) const {
    const std::size_t n = K.size();
    std::fill_n(z.begin(), n, 0.0);
    z[n] = value_of(this->Fs);
    Mode mode{};
    for (std::size_t i = 0; i < n; ++i) {
      const double force = value_of(sigma[i]) * in.v, cap = value_of(lambda[i]) * z[n];
      if (force > cap || force < -cap) mode = with(mode, i, force > cap ? 1 : 2);
    }
    return mode;
  }

  static bool is_passive() { return true; }
  /// |F - sigma2 v| <= Fs, which caps it.
  std::optional<double> force_bound(double speed) const { return this->bound_with_viscous(sigma2, speed); }
  std::vector<std::pair<double, double>> state_bounds() const {
    std::vector<std::pair<double, double>> bounds;
    bounds.reserve(K.size() + 1);
    for (std::size_t i = 0; i < K.size(); ++i) {
      const double most = value_of(lambda[i]) * this->highest_level() / value_of(K[i]);
      bounds.emplace_back(-most, most);
    }
    bounds.emplace_back(this->lowest_level(), this->highest_level());
    return bounds;
  }
  bool odd() const { return this->symmetric(); }
  Mode mirror(Mode mode) const {
    Mode mirrored{};
    for (std::size_t i = 0; i < K.size(); ++i)
      if (const int where = code(mode, i)) mirrored = with(mirrored, i, 3 - where);
    return mirrored;
  }
  bool even_state(int i) const { return i == static_cast<int>(K.size()); }
  Scales scales() const {
    double shortest = infinite;
    for (std::size_t i = 0; i < K.size(); ++i)
      shortest = std::min(shortest, value_of(lambda[i]) * value_of(this->Fs) / value_of(K[i]));
    return {.displacement = shortest, .velocity = value_of(this->vs), .output = value_of(this->Fs)};
  }
  double state_scale(int i) const {
    const auto k = static_cast<std::size_t>(i);
    return k == K.size() ? value_of(this->Fs) : value_of(lambda[k]) * value_of(this->Fs) / value_of(K[k]);
  }

 private:
  static constexpr double overlap = 1e-12;  // of the cap
  static int code(Mode mode, std::size_t i) { return static_cast<int>(mode.value >> (2 * i) & 3); }
  static Mode with(Mode mode, std::size_t i, int where) {
    return {(mode.value & ~(std::int64_t{3} << (2 * i))) | (std::int64_t{where} << (2 * i))};
  }
  S trial(const Input<S>& in, std::span<const S> z, std::size_t i) const { return K[i] * z[i] + sigma[i] * in.v; }
};

}  // namespace limcycle
