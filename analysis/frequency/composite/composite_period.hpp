#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "limcycle/analysis/frequency/composite/composite_describing_function.hpp"
#include "limcycle/analysis/frequency/composite/composite_march.hpp"
#include "limcycle/analysis/frequency/march/steady_sliding.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// Periodic steady state of mass and friction under a harmonic force, by a Newton iteration on its period map.
template <int D>
class CompositePeriod {
 public:
  using March = CompositeMarch<D>;
  using State = typename March::State;

  CompositePeriod(const Element& law, double mass) : march_(law, mass), mass_(mass) {}

  /// A solution to the tolerance of the integrator `relative`; x's harmonics up to `orders`.
  CompositeResponse solve(const CompositePoint& point, double relative, int orders, const CompositeResponse* near) {
    point_ = point;
    orders_ = orders;
    tolerance_.relative = relative;
    half_ = march_.law().odd() && point.mean_velocity == 0.0 && !point.bias;
    free_ = !half_ && !point.bias;
    maps_ = 0;
    const long before = march_.steps();
    guess(near);
    const Status status = iterate(3.0 * relative);
    CompositeResponse response = answer(status);
    response.steps = march_.steps() - before;
    return response;
  }

  /// See CompositeDescribingFunction::break_away. True if the body breaks away.
  bool tears_loose(double force, double frequency) {
    point_ = {force, frequency, 0.0};
    const double scale = march_.law().scales().velocity;
    tolerance_ = {1e-4, velocity_scale(force / (mass_ * frequency)), force / (mass_ * frequency * frequency)};
    State s = march_.rest();
    march_.start(s, {0.0, force, frequency}, 0.0);
    const double limit = std::isfinite(scale) ? scale : 0.0;
    const int halves = march_.size() > 1 ? 2 : 1;  // the later one begins with the bristles bent the other way
    for (int quarter = 0; quarter < 2 * halves; ++quarter) {
      CompositeSums sums;
      const CompositeForce push{0.0, quarter < 2 ? force : -force, frequency};
      if (march_.run(s, push, quarter % 2, quarter % 2 + 1, tolerance_, sums, false, limit) != Status::converged)
        return true;
      if (sums.peak_speed > limit) return true;
    }
    return false;
  }

  /// The same under a bias: true if it breaks away in that direction within a period and a half.
  bool tears_loose(double bias, double force, double frequency, double direction) {
    point_ = {force, frequency, 0.0, bias};
    const double scale = march_.law().scales().velocity, limit = std::isfinite(scale) ? scale : 0.0;
    tolerance_ = {1e-4, velocity_scale(force / (mass_ * frequency)), force / (mass_ * frequency * frequency)};
    State s = march_.rest();
    const CompositeForce push{bias, force, frequency};
    march_.start(s, push, 0.0);
    for (int quarter = 0; quarter < 6; ++quarter) {
      CompositeSums sums;
      if (march_.run(s, push, quarter % 4, quarter % 4 + 1, tolerance_, sums) != Status::converged) return true;
      if (sums.peak_speed > limit && sums.displacement * direction > 0.0) return true;
    }
    return false;
  }
  /// Sets a function that is called often; true ends the computation with Status::interrupted (tears_loose: with true).
  void stop_with(std::function<bool()> stop) { march_.stop_with(std::move(stop)); }
  long steps() const { return march_.steps(); }
  bool has_front() const { return march_.has_modes() || std::isfinite(march_.law().scales().velocity); }
  double level() const { return march_.law().scales().output; }

 private:
  static constexpr double pi = 3.14159265358979323846;
  static constexpr double creep_share = 10.0;

  struct Trip {
    Status status = Status::converged;
    State end;
    CompositeSums sums;
  };

  /// Marches half a period and reflects, or a whole period.
  Trip go(const State& from, double bias, bool replay = false) {
    Trip trip{Status::converged, from, {}};
    trip.sums.orders = orders_;
    ++maps_;
    trip.status =
        march_.run(trip.end, {bias, point_.force, point_.frequency}, 0, half_ ? 2 : 4, tolerance_, trip.sums, replay);
    if (half_) {
      for (std::size_t i = 0; i < march_.size(); ++i)
        if (i == 0 || !is_even_state(march_.law(), static_cast<int>(i) - 1)) trip.end.y[i] = -trip.end.y[i];
      trip.end.mode = march_.law().mirror(trip.end.mode);
    }
    return trip;
  }

  std::size_t unknowns() const { return march_.size() + (free_ ? 1 : 0); }
  double scale_of(std::size_t i) const {
    if (i == 0) return speed_;
    return i < march_.size() ? march_.law().state_scale(static_cast<int>(i) - 1) : march_.law().scales().output;
  }

  void guess(const CompositeResponse* near) {
    state_ = march_.rest();
    bias_ = 0.0;
    const double inertial = point_.force / (mass_ * point_.frequency);
    const double V = point_.mean_velocity;
    speed_ = inertial + std::abs(V);
    if (near && near->start.size() == march_.size()) {
      std::copy(near->start.begin(), near->start.end(), state_.y.begin());
      state_.mode = near->mode;
      bias_ = free_ ? near->bias : point_.bias.value_or(0.0);
      speed_ = std::max(near->peak_speed, 1e-9 * speed_);
    } else if (point_.bias) {
      bias_ = *point_.bias;
      march_.start(state_, {bias_, point_.force, point_.frequency}, 0.0);
    } else if (half_) {
      // Share of the force that remains after a constant level of friction, at least 0.
      const double left = std::max(0.0, 1.0 - 1.3 * march_.law().scales().output / point_.force);
      state_.y[0] = -inertial * left;
      march_.start(state_, {0.0, point_.force, point_.frequency}, 0.0);
    } else {
      slide(inertial);
    }
    set_tolerance();
  }

  /// Steady sliding at the mean velocity, with the ripple that the mass alone would have.
  void slide(double inertial) {
    const double V = point_.mean_velocity;
    state_.y[0] = V - inertial;
    const SteadySliding relaxed(march_.law(), V);
    for (std::size_t k = 1; k < march_.size(); ++k) state_.y[k] = relaxed.z[k - 1];
    bias_ = relaxed.force;
    march_.start(state_, {bias_, point_.force, point_.frequency}, 0.0);
  }

  /// Creep decides if and when a body breaks away. It is a displacement of the bristles in part of a period, so its
  /// speed counts, not only the Stribeck velocity.
  double velocity_scale(double speed) const {
    const Scales scales = march_.law().scales();
    const double creep = creep_share * scales.displacement * point_.frequency;
    return std::min({speed, scales.velocity, std::isfinite(creep) ? creep : infinite});
  }

  void set_tolerance() {
    tolerance_.velocity = velocity_scale(speed_);
    tolerance_.length = length_ > 0.0 ? length_ : speed_ / point_.frequency;
    length_ = 0.0;
  }

  /// Scaled defect of periodicity and, with a bias, of the mean velocity.
  double defect(const Trip& trip, const State& from, std::vector<double>& r) const {
    r.assign(unknowns(), 0.0);
    double worst = 0.0;
    for (std::size_t i = 0; i < march_.size(); ++i) r[i] = (trip.end.y[i] - from.y[i]) / scale_of(i);
    if (free_) r.back() = (trip.sums.displacement * point_.frequency / (2.0 * pi) - point_.mean_velocity) / speed_;
    for (const double value : r) worst = std::max(worst, std::isfinite(value) ? std::abs(value) : infinite);
    return worst;
  }

  Status iterate(double goal) {
    double before = infinite, best = infinite;
    bool newton = false;
    int plain = free_ ? 1 : 2;  // maps before Newton's method may begin
    int no_better = 0;
    Trip kept;
    State kept_state;
    double kept_bias = 0.0;
    for (int iteration = 0; iteration < 40 && maps_ < 150; ++iteration) {
      trip_ = go(state_, bias_);
      if (trip_.status != Status::converged) return trip_.status;
      const bool measured = trip_.sums.peak_speed > 0.3 * speed_;  // to a tolerance that fits the motion
      speed_ = std::max(trip_.sums.peak_speed, 1e-300);
      length_ = twice() * std::hypot(trip_.sums.sine[0], trip_.sums.cosine[0]);
      set_tolerance();
      const double worst = defect(trip_, state_, residual_);
      if (!std::isfinite(worst)) return Status::not_finite;
      if (worst <= goal && (measured || trip_.sums.peak_speed == 0.0)) return Status::converged;
      if (measured && worst < 0.7 * best) {
        best = worst;
        kept = trip_;
        kept_state = state_;
        kept_bias = bias_;
        no_better = 0;
      } else if (++no_better >= 5 && best < 300.0 * goal) {
        break;  // the tolerance of the steps allows no more; `error` shows it
      }
      const bool contracts = worst < 0.15 * before;
      if (plain > 0 || !measured || (contracts && !newton && !free_)) {
        --plain;
        state_ = trip_.end;
      } else {
        if (worst > 3.0 * before && newton) plain = 2;
        if (!(newton && contracts) && !differentiate()) return Status::stalled;
        newton = true;
        if (!newton_step()) return Status::stalled;
      }
      before = worst;
    }
    if (!(best < 300.0 * goal)) return Status::max_iterations;
    trip_ = kept;
    state_ = kept_state;
    bias_ = kept_bias;
    speed_ = std::max(trip_.sums.peak_speed, 1e-300);
    return Status::converged;
  }
  double twice() const { return half_ ? 2.0 : 1.0; }

  /// Derivative of the scaled residual by the unknowns, by differences on the same steps.
  bool differentiate() {
    const std::size_t n = unknowns();
    jacobian_.assign(n * n, 0.0);
    const double delta = march_.has_modes() ? std::clamp(0.3 * std::sqrt(tolerance_.relative), 1e-6, 1e-3) : 1e-6;
    std::vector<double> r;
    for (std::size_t j = 0; j < n; ++j) {
      if (j > 0 && j < march_.size() && march_.law().unused(state_.mode, static_cast<int>(j) - 1)) {
        jacobian_[j * n + j] = -1.0;
        continue;
      }
      State moved = state_;
      double bias = bias_;
      if (j < march_.size()) {
        moved.y[j] += delta * scale_of(j);
        if (j == 0) march_.start(moved, {bias, point_.force, point_.frequency}, 0.0);
      } else {
        bias += delta * scale_of(j);
      }
      const Trip trip = go(moved, bias, true);
      if (trip.status != Status::converged) return false;
      defect(trip, moved, r);
      for (std::size_t i = 0; i < n; ++i) jacobian_[i * n + j] = (r[i] - residual_[i]) / delta;
    }
    return true;
  }

  bool newton_step() {
    const std::size_t n = unknowns();
    std::vector<double> system(n * (n + 1));
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) system[i * (n + 1) + j] = jacobian_[i * n + j];
      system[i * (n + 1) + n] = -residual_[i];
    }
    if (!eliminate(system, n, 1)) return false;
    double longest = 0.0;
    for (std::size_t i = 0; i < n; ++i) longest = std::max(longest, std::abs(system[i * (n + 1) + n]));
    const double damp = longest > 2.0 ? 2.0 / longest : 1.0;
    for (std::size_t i = 0; i < march_.size(); ++i) state_.y[i] += damp * system[i * (n + 1) + n] * scale_of(i);
    if (free_) bias_ += damp * system[n * (n + 1) - 1] * scale_of(march_.size());
    march_.start(state_, {bias_, point_.force, point_.frequency}, 0.0);
    return true;
  }

  CompositeResponse answer(Status status) const {
    CompositeResponse r;
    r.status = status;
    r.maps = maps_;
    r.symmetric = half_;
    r.harmonics.assign(static_cast<std::size_t>(orders_), 0.0);
    if (status != Status::converged) return r;
    const CompositeSums& sums = trip_.sums;
    for (int k = 1; k <= orders_; ++k) {
      if (half_ && k % 2 == 0) continue;
      const auto i = static_cast<std::size_t>(k - 1);
      // v = w k (Xs cos - Xc sin): the sine coefficient of x comes from the integral with the cosine.
      r.harmonics[i] = twice() / (pi * k) * std::complex<double>(sums.cosine[i], -sums.sine[i]);
    }
    r.gain = r.harmonics[0] / point_.force;
    r.bias = bias_;
    r.mean_velocity = half_ ? 0.0 : sums.displacement * point_.frequency / (2.0 * pi);
    r.dissipation = twice() * sums.work;
    r.sticking_fraction = std::clamp(twice() * sums.stuck / (2.0 * pi), 0.0, 1.0);
    r.peak_speed = sums.peak_speed;
    r.start.assign(state_.y.begin(), state_.y.end());
    r.mode = state_.mode;
    std::vector<double> left;
    r.error = defect(trip_, state_, left);
    return r;
  }

  March march_;
  double mass_;
  CompositePoint point_;
  CompositeTolerance tolerance_;
  int orders_ = 1;
  bool half_ = true, free_ = false;  // half a period is enough; the bias is an unknown
  int maps_ = 0;
  State state_;
  double bias_ = 0.0, speed_ = 1.0, length_ = 0.0;
  Trip trip_;
  std::vector<double> residual_, jacobian_;
};

}  // namespace limcycle
