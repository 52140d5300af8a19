#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "limcycle/analysis/illinois.hpp"
#include "limcycle/analysis/study/identify/record/record.hpp"
#include "limcycle/models/dual.hpp"
#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Slots of the dual numbers on which a record is marched: seven numbers of the law, and time (or all states alike).
inline constexpr int march_slots = 8;
using MarchDual = Dual<march_slots>;
inline constexpr std::size_t time_slot = march_slots - 1;

/// Velocity of a piece at a time that may be a dual number.
template <class T>
T velocity_in(const MotionPiece& piece, const T& time) {
  const T s = time / piece.duration;
  return piece.v0 + s * (piece.v1 + s * piece.v2);
}

/// One law on the scalar S, driven through the pieces of a record: see FrictionResponse.
template <class S, template <class> class Law>
class RecordMarch {
 public:
  /// `probe`: the same law on Dual<1>, for relaxation rates.
  RecordMarch(const Law<S>& law, const Law<Dual<1>>& probe, const Law<MarchDual>& sliding, double fineness)
      : law_(law),
        probe_(probe),
        sliding_(sliding),
        fineness_(fineness),
        n_(static_cast<std::size_t>(law.states())),
        z_(n_, S(0.0)),
        probe_z_(n_),
        probe_dz_(n_) {
    for (auto* stage : {&trial_, &k1_, &k2_, &k3_, &k4_, &stage_}) stage->assign(n_, S(0.0));
  }

  void begin_relaxed(double v) {
    std::ranges::fill(z_, S(0.0));
    mode_ = {};
    if constexpr (HasModes<Law<S>, S>) {
      std::vector<double> at(n_, 0.0);
      mode_ = law_.start(Input<double>{0.0, v, drive(v)}, at);
    }
  }

  /// State after long sliding: where the rates vanish, by Newton's method. Each state has the others' slot, as the
  /// states of these laws do not affect one another; derivatives by numbers follow as for any implicit function.
  void begin_sliding(double v) {
    std::vector<double> at(n_, 0.0);
    const Input<double> in{0.0, v, drive(v)};
    mode_ = {};
    if constexpr (KnowsSliding<Law<S>>)
      mode_ = law_.after_sliding(in, at);
    else if constexpr (HasModes<Law<S>, S>)
      mode_ = law_.start(in, at);
    std::vector<MarchDual> z(at.begin(), at.end()), rate(n_);
    for (int pass = 0; pass < 4; ++pass) {
      for (auto& one : z) one.d[time_slot] = 1.0;
      sliding_.rate(Input<MarchDual>{MarchDual(0.0), MarchDual(v), MarchDual(drive(v))}, mode_, z, rate);
      for (std::size_t i = 0; i < n_; ++i) {
        const double slope = rate[i].d[time_slot];
        z[i].d[time_slot] = 0.0;
        rate[i].d[time_slot] = 0.0;
        if (slope < 0.0) z[i] -= rate[i] / slope;
      }
    }
    for (std::size_t i = 0; i < n_; ++i) z_[i] = taken(z[i]);
  }

  S force(double v) const { return law_.output(input(S(v), v), mode_, z_); }
  bool finite() const {
    return std::ranges::all_of(z_, [](const S& one) { return std::isfinite(value_of(one)); });
  }

  /// Through a whole piece. False if the law does not stop switching.
  bool cross(const MotionPiece& piece) {
    if (n_ == 0) return true;
    if (!settle(moving_velocity(piece, 0.0))) return false;
    const double from = begin_of_march(piece);
    if (from > 0.0) begin_sliding(moving_velocity(piece, from));
    S time(from * piece.duration);
    int events = 0;
    while (value_of(time) < piece.duration * (1.0 - 1e-12)) {
      const double left = piece.duration - value_of(time);
      const double v = velocity_in(piece, value_of(time)), ahead = velocity_in(piece, value_of(time) + 0.5 * left);
      const double h = std::min(longest_step(std::abs(v) > std::abs(ahead) ? v : ahead), left);
      S step = h < left * (1.0 - 1e-9) ? S(h) : S(piece.duration) - time;
      advance(piece, time, step, trial_);
      if constexpr (HasModes<Law<S>, S>) {
        if (const auto [guard, share] = first_broken(piece, time, step); guard >= 0) {
          if (++events > 200) return false;
          const S until = switch_time(piece, time, value_of(step) * share, guard);
          advance(piece, time, until, trial_);
          time = time + until;
          z_ = trial_;
          fire(piece, time, guard);
          continue;
        }
      }
      z_.swap(trial_);
      time = time + step;
      if (!finite()) return false;
    }
    return true;
  }

 private:
  static constexpr bool one_state = [] {
    if constexpr (requires { Law<S>::is_one_state; }) return bool(Law<S>::is_one_state);
    return false;
  }();

  static double drive(double v) { return v < 0.0 ? -infinite : infinite; }
  static Input<S> input(const S& v, double direction) { return {S(0.0), v, S(drive(direction))}; }
  static S taken(const MarchDual& from) {
    if constexpr (std::same_as<S, double>)
      return from.value;
    else
      return from;
  }
  /// Velocity at a share of a piece; at a reversal a small one in the direction of the piece.
  static double moving_velocity(const MotionPiece& piece, double s) {
    const double v = piece.velocity(s), least = 1e-9 * piece.velocity(0.5);
    return v * least > least * least ? v : least;
  }

  /// Share of a piece from which on the state depends on the motion: 0 unless the piece is long for the bristle.
  double begin_of_march(const MotionPiece& piece) {
    if constexpr (!one_state) {
      return 0.0;
    } else {
      const double length = law_.scales().displacement, whole = std::abs(piece.displacement());
      const double change = std::max(std::abs(piece.v1), std::abs(piece.v1 + 2.0 * piece.v2)) / piece.duration;
      turning_ = change > 0.0 ? 0.5 * std::sqrt(length / change) : infinite;
      constexpr double lengths = 10.0;
      if (!(whole > lengths * length)) return 0.0;
      // Its lag behind steady sliding is a share length/whole of what the level changes within the piece.
      if (whole > (linear_in_state() ? 250.0 : 100.0) * length &&
          std::abs(piece.velocity(1.0)) > 0.5 * std::abs(piece.velocity(0.5)))
        return 1.0;
      double low = 0.0, high = 1.0;
      for (int i = 0; i < 60 && high - low > 1e-3 * (1.0 - low); ++i) {
        const double s = 0.5 * (low + high);
        (std::abs(piece.displacement(s)) > lengths * length ? low : high) = s;
      }
      return low;
    }
  }

  /// Without the derivative by time.
  static void drop_time(std::vector<S>& z) {
    if constexpr (!std::same_as<S, double>)
      for (auto& one : z) one.d[time_slot] = 0.0;
  }

  /// Step at this velocity, s.
  double longest_step(double v) {
    for (std::size_t i = 0; i < n_; ++i) probe_z_[i] = Dual<1>::variable(value_of(z_[i]), 0);
    probe_.rate(Input<Dual<1>>{Dual<1>(0.0), Dual<1>(v), Dual<1>(drive(v))}, mode_, probe_z_, probe_dz_);
    double rate = 0.0;
    for (const auto& one : probe_dz_) rate = std::max(rate, std::abs(one.d[0]));
    double h = rate > 0.0 ? 0.25 / rate : infinite;
    if constexpr (one_state) {
      const double share = linear_in_state() ? 0.25 : 0.1;
      // Where the velocity passes 0 a step is long in time, and its error one of the change of the velocity.
      h = std::min({h, share * law_.scales().displacement / std::abs(v), turning_});
    }
    return h / fineness_;
  }
  bool linear_in_state() const {
    if constexpr (requires { law_.is_linear_in_state(); }) return law_.is_linear_in_state();
    return false;
  }

  void slope(const MotionPiece& piece, const S& time, const std::vector<S>& z, std::vector<S>& dz) {
    const S v = velocity_in(piece, time);
    law_.rate(input(v, value_of(v)), mode_, z, dz);
  }
  /// A step of the classical Runge-Kutta method from z_.
  void advance(const MotionPiece& piece, const S& time, const S& h, std::vector<S>& to) {
    slope(piece, time, z_, k1_);
    for (std::size_t i = 0; i < n_; ++i) stage_[i] = z_[i] + 0.5 * h * k1_[i];
    slope(piece, time + 0.5 * h, stage_, k2_);
    for (std::size_t i = 0; i < n_; ++i) stage_[i] = z_[i] + 0.5 * h * k2_[i];
    slope(piece, time + 0.5 * h, stage_, k3_);
    for (std::size_t i = 0; i < n_; ++i) stage_[i] = z_[i] + h * k3_[i];
    slope(piece, time + h, stage_, k4_);
    for (std::size_t i = 0; i < n_; ++i) to[i] = z_[i] + h / 6.0 * (k1_[i] + 2.0 * (k2_[i] + k3_[i]) + k4_[i]);
  }

  /// Guards of the state `z` at a time.
  void guards_at(const MotionPiece& piece, const S& time, const std::vector<S>& z) {
    const S v = velocity_in(piece, time);
    guards_.resize(static_cast<std::size_t>(law_.guards(mode_)));
    law_.guard(input(v, value_of(v)), mode_, z, guards_);
  }

  struct Broken {
    int guard = -1;
    double share = 0.0;  ///< of the step at which it breaks
  };
  /// The guard that breaks first within a step that ends at trial_; by regula falsi (Illinois) each.
  Broken first_broken(const MotionPiece& piece, const S& time, const S& step) {
    guards_at(piece, time + step, trial_);
    at_end_.clear();
    for (const auto& one : guards_) at_end_.push_back(value_of(one));
    Broken first;
    for (std::size_t k = 0; k < at_end_.size(); ++k) {
      if (!(at_end_[k] < 0.0)) continue;
      const double share = share_of_break(piece, time, value_of(step), k, at_end_[k]);
      if (first.guard < 0 || share < first.share) first = {static_cast<int>(k), share};
    }
    return first;
  }
  double share_of_break(const MotionPiece& piece, const S& time, double step, std::size_t k, double at_end) {
    guards_at(piece, time, z_);
    const double at_start = value_of(guards_[k]);
    if (!(at_start > 0.0)) return 0.0;
    const auto guard = [&](double share) -> std::optional<double> {
      advance(piece, time, S(step * share), stop_);
      guards_at(piece, time + step * share, stop_);
      return value_of(guards_[k]);
    };
    return falling_zero(guard, 0.0, at_start, 1.0, at_end, 1e-14 * (at_start - at_end));
  }

  /// The length `h` of the step to the switch, with its derivatives: those at which the guard stays 0.
  S switch_time(const MotionPiece& piece, const S& time, double h, int guard) {
    if constexpr (std::same_as<S, double>) {
      return h;
    } else {
      S varied(h);
      varied.d[time_slot] = 1.0;
      advance(piece, time, varied, stop_);
      guards_at(piece, time + varied, stop_);
      S value = guards_[static_cast<std::size_t>(guard)];
      const double by_time = value.d[time_slot];
      S result(h);
      if (by_time < 0.0)
        for (std::size_t j = 0; j < time_slot; ++j) result.d[j] = -value.d[j] / by_time;
      return result;
    }
  }

  void fire(const MotionPiece& piece, const S& time, int guard) {
    const S v = velocity_in(piece, time);
    mode_ = law_.next(input(v, velocity_in(piece, 0.5 * (value_of(time) + piece.duration))), mode_, z_, guard);
    drop_time(z_);
  }

  /// Switches that a change of the sign of the velocity brings, at a given state.
  bool settle(double v) {
    if constexpr (HasModes<Law<S>, S>) {
      for (int events = 0; events < 200; ++events) {
        guards_.resize(static_cast<std::size_t>(law_.guards(mode_)));
        law_.guard(input(S(v), v), mode_, z_, guards_);
        const auto broken = std::ranges::find_if(guards_, [](const S& one) { return value_of(one) < 0.0; });
        if (broken == guards_.end()) return true;
        mode_ = law_.next(input(S(v), v), mode_, z_, static_cast<int>(broken - guards_.begin()));
      }
      return false;
    } else {
      return true;
    }
  }

  const Law<S>& law_;
  const Law<Dual<1>>& probe_;
  const Law<MarchDual>& sliding_;
  double fineness_;
  std::size_t n_;
  double turning_ = infinite;  ///< time in which a change of the velocity moves the bristle by an eighth, s
  Mode mode_{};
  std::vector<S> z_, trial_, stop_ = std::vector<S>(n_), k1_, k2_, k3_, k4_, stage_, guards_;
  std::vector<Dual<1>> probe_z_, probe_dz_;
  std::vector<double> at_end_;  ///< guards at the end of a step
};

}  // namespace limcycle
