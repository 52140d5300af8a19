#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "limcycle/analysis/frequency/composite/composite_step.hpp"
#include "limcycle/analysis/motion/steppers/step_to_zero.hpp"
#include "limcycle/analysis/status.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// Marches a mass with one friction law under a harmonic force, step by step (see CompositeStep). The embedded solution
/// controls the step size; switches of the law are located by repeating the step with other lengths. The steps also end
/// at the extremes and zeros of u, so that a stuck body never breaks away unseen. Cost: about 1 us a step with two
/// unknowns.
template <int D>
class CompositeMarch : public CompositeStep<D> {
 public:
  using Base = CompositeStep<D>;
  using typename Base::State;
  using typename Base::Vector;

  CompositeMarch(const Element& law, double mass) : Base(law, mass), has_modes_(law.has_modes()) {
    const double scale = law.scales().velocity;
    slow_ = std::isfinite(scale) && !has_modes_ ? 0.01 * scale : 0.0;
  }

  bool has_modes() const { return has_modes_; }
  /// Sets a function that is called at every run and every 256 steps: true ends the run with Status::interrupted.
  void stop_with(std::function<bool()> stop) { stop_ = std::move(stop); }

  State rest() const {
    State s;
    resize(s.y);
    return s;
  }

  /// Mode (and states) of a body without history with velocity y[0] at this phase; laws without modes: nothing to do.
  void start(State& s, const CompositeForce& force, double phase) {
    if (has_modes_) {
      const Input<double> in{0.0, s.y[0], force.bias + force.amplitude * std::sin(phase)};
      s.mode = law_.start(in, std::span<double>(s.y.data() + 1, d_ - 1));
    }
  }

  /// Marches from quarter `from_quarter` to `to_quarter` (phases in multiples of pi/2). Adds to `sums`. `replay`:
  /// repeats the very steps of the last run without replay, so that differences of the two are smooth (laws without
  /// modes; others choose their steps anew). Ends once the speed exceeds `fast`.
  Status run(State& s, const CompositeForce& force, int from_quarter, int to_quarter,
             const CompositeTolerance& tolerance, CompositeSums& sums, bool replay = false, double fast = infinite) {
    replay_ = replay && !has_modes_;
    next_ = 0;
    if (!replay_) taken_.clear();
    this->prepare(force, tolerance, sums.orders);
    sums.sine.resize(orders_);
    sums.cosine.resize(orders_);
    h_ = 1e-2;
    events_ = 0;
    asked_ = 0;
    const long budget = steps_ + 20000;
    for (int quarter = from_quarter; quarter < to_quarter; ++quarter) {
      phase_ = half_pi * (quarter % 4);
      const double end = half_pi * (quarter % 4 + 1);
      while (phase_ < end) {
        if (steps_ > budget) return Status::max_iterations;
        if (stop_ && asked_++ % 256 == 0 && stop_()) return Status::interrupted;
        const Status status = step(s, end, sums);
        if (status != Status::converged || sums.peak_speed > fast) return status;
      }
    }
    return Status::converged;
  }

 private:
  using Base::attempt, Base::begin, Base::error_norm, Base::field, Base::held, Base::resize, Base::states;
  using Base::law_, Base::d_, Base::orders_, Base::force_, Base::phase_, Base::mode_, Base::steps_, Base::y1_,
      Base::q1_, Base::stage_, Base::rate0_, Base::rate_;
  static constexpr double half_pi = 1.57079632679489661923;

  /// One accepted step, ending at a switch if there is one.
  Status step(State& s, double end, CompositeSums& sums) {
    begin(s);
    if (replay_) return repeat_step(s, end, sums);
    double h = std::min(h_, end - phase_);
    // Two steps of equal length rather than a tiny last one.
    if (h < end - phase_ && h > 0.6 * (end - phase_)) h = 0.5 * (end - phase_);
    const bool shortened = h < h_;
    double error = infinite;
    for (int tries = 0;; ++tries) {
      error = attempt(h) ? error_norm() : infinite;
      if (error <= 1.0) break;
      if (tries > 60 || h < 1e-14) return std::isfinite(error) ? Status::stalled : Status::not_finite;
      h *= std::isfinite(error) ? std::clamp(0.9 * std::pow(error, -0.2), 0.1, 0.8) : 0.1;
    }
    const double grown = h * std::clamp(0.9 * std::pow(std::max(error, 1e-12), -0.2), 0.3, 6.0);
    h_ = shortened ? std::max(h_, grown) : grown;
    if (h_ > half_pi) h_ = half_pi;
    int fired = -1;
    if (has_modes_) {
      double low = 0.0, high = h;
      if (switches_within(s, h, low, high, fired)) h = locate(s, fired, h, low, high);
    }
    if (h > 0.0) add(s, h, sums);
    taken_.push_back(h);
    const bool last = fired < 0 && h >= (end - phase_) * (1.0 - 1e-14);
    if (h > 0.0) s.y = y1_;
    phase_ = last ? end : phase_ + h;
    if (fired >= 0) {
      if (++events_ > 500) return Status::chattering;
      fire(s, fired);
    }
    return Status::converged;
  }

  Status repeat_step(State& s, double end, CompositeSums& sums) {
    if (next_ >= taken_.size()) return Status::stalled;
    const double h = taken_[next_++];
    if (!attempt(h) || !std::isfinite(y1_[0])) return Status::not_finite;
    add(s, h, sums);
    s.y = y1_;
    phase_ = h >= (end - phase_) * (1.0 - 1e-14) ? end : phase_ + h;
    return Status::converged;
  }

  void add(const State& s, double h, CompositeSums& sums) const {
    sums.displacement += q1_[0];
    sums.work += q1_[1];
    for (std::size_t k = 0; k < orders_; ++k) {
      sums.sine[k] += q1_[2 + 2 * k];
      sums.cosine[k] += q1_[3 + 2 * k];
    }
    const double a = s.y[0], b = y1_[0];
    sums.peak_speed = std::max({sums.peak_speed, std::abs(a), std::abs(b)});
    if (held(s.mode)) {
      sums.stuck += h;
    } else if (slow_ > 0.0) {  // share of the straight line from a to b within +-slow
      const double low = std::clamp(std::min(a, b), -slow_, slow_), high = std::clamp(std::max(a, b), -slow_, slow_);
      sums.stuck += a == b ? (std::abs(a) < slow_ ? h : 0.0) : h * (high - low) / std::abs(b - a);
    }
  }

  Input<double> input_at(const Vector& y, double phase) const {
    return {0.0, y[0], force_.bias + force_.amplitude * std::sin(phase)};
  }
  void guards(const Vector& y, Mode mode, double phase, std::vector<double>& g) const {
    g.resize(static_cast<std::size_t>(law_.guards(mode)));
    law_.guard(input_at(y, phase), mode, states(y), g);
  }

  /// Puts the cubic through the ends of the step of length h, at a share of it, into stage_.
  void interpolate(const State& s, double h, double theta) {
    const double left = 1.0 - theta;
    for (std::size_t i = 0; i < d_; ++i) {
      const double chord = y1_[i] - s.y[i];
      stage_[i] = left * s.y[i] + theta * y1_[i] -
                  theta * left * ((1.0 - 2.0 * theta) * chord + h * (theta * rate_[i] - left * rate0_[i]));
    }
  }

  /// Searches the quarters of the step for the first guard that has turned negative.
  bool switches_within(const State& s, double h, double& low, double& high, int& fired) {
    field(y1_, mode_, std::sin(phase_ + h), rate_);
    for (int quarter = 1; quarter <= 4; ++quarter) {
      const double theta = 0.25 * quarter;
      interpolate(s, h, theta);
      guards(quarter == 4 ? y1_ : stage_, s.mode, phase_ + theta * h, guards_);
      for (std::size_t k = 0; k < guards_.size(); ++k)
        if (guards_[k] < 0.0) {
          fired = static_cast<int>(k);
          high = theta * h;
          return true;
        }
      low = theta * h;
    }
    return false;
  }

  /// Length at which the guard has just turned negative, of a step of length h; that step is then the last one taken.
  double locate(const State& s, int fired, double h, double low, double high) {
    const auto value = [&](const Vector& y, double length) {
      guards(y, s.mode, phase_ + length, guards_);
      return guards_[static_cast<std::size_t>(fired)];
    };
    if (low == 0.0 && value(s.y, 0.0) <= 0.0) return 0.0;
    const auto between = [&](double length) {
      interpolate(s, h, length / h);
      return value(stage_, length);
    };
    const auto by_step = [&](double length) {
      attempt(length);
      return value(y1_, length);
    };
    const auto expected = on_interpolant(between, low, high);
    const double rounding = 2e-16 * (1.0 + phase_), found = step_to_zero(by_step, low, high, expected, h, rounding);
    const double now = value(y1_, found);
    return now > 0.0 ? just_beyond(by_step, now, found, high, rounding) : found;
  }

  void fire(State& s, int fired) {
    if (has_modes_) {
      if (arrests(law_, s.mode, fired)) s.y[0] = 0.0;
      s.mode = law_.next(input_at(s.y, phase_), s.mode, std::span<double>(s.y.data() + 1, d_ - 1), fired);
      if (held(s.mode)) s.y[0] = 0.0;
      h_ = std::min(h_, 0.05);
    }
  }

  bool has_modes_;
  double slow_ = 0.0, h_ = 0.0;
  int events_ = 0, asked_ = 0;
  std::function<bool()> stop_;
  bool replay_ = false;
  std::size_t next_ = 0;
  std::vector<double> taken_, guards_;
};

}  // namespace limcycle
