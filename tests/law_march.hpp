#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <stdexcept>
#include <vector>

#include "limcycle/models/element/concepts.hpp"

/// A simple integration of one law along a prescribed motion, for tests: Runge-Kutta of order 4 with small steps,
/// switches by bisection. It shares no code with the methods that it checks.
namespace limcycle::test {

/// Largest steps of a march.
struct MarchSteps {
  double displacement = infinite;  ///< m
  double velocity = infinite;      ///< change of speed, m/s
  double time = infinite;          ///< s
};

template <class Law>
class LawMarch {
 public:
  static constexpr bool switches = HasModes<Law, double>;

  LawMarch(Law law, MarchSteps steps) : law_(std::move(law)), steps_(steps) {
    z_.assign(static_cast<std::size_t>(law_.states()), 0.0);
  }

  /// Called after every step with input, mode and state.
  std::function<void(const Input<double>&, Mode, const std::vector<double>&)> watch;
  /// Called at every switch with the input and the guard that fired, before it.
  std::function<void(const Input<double>&, Mode, const std::vector<double>&, int)> switching;

  /// Moves to x in time T, starting and ending at rest.
  void glide(double to, double T) { stroke(to, T, true); }
  /// Moves to x in time T at constant speed.
  void slide(double to, double T) { stroke(to, T, false); }

  double x() const { return x_; }
  double force() const { return law_.output(at(1.0), mode_, z_); }
  double work() const { return work_; }         ///< done on the law since the start, J
  double least_work() const { return least_; }  ///< least value of it so far
  long events() const { return events_; }
  Mode mode() const { return mode_; }
  const std::vector<double>& z() const { return z_; }
  const Law& law() const { return law_; }

 private:
  /// Input at the fraction s of the stroke.
  Input<double> at(double s) const {
    using std::numbers::pi;
    const double way = to_ - from_, direction = way < 0.0 ? -1.0 : 1.0;
    if (!smooth_) return {from_ + way * s, way / T_, direction * infinite};
    const double half = std::sin(0.5 * pi * s), near_end = std::min(s, 1.0 - s);
    const double pull = s < 0.5 ? direction : -direction;  // sign of the acceleration
    return {from_ + way * half * half, 0.5 * pi * way / T_ * std::sin(pi * near_end), pull * infinite};
  }

  void stroke(double to, double T, bool smooth) {
    from_ = x_, to_ = to, T_ = T, smooth_ = smooth;
    if (!begun_) {
      begun_ = true;
      if constexpr (switches) mode_ = law_.start(at(0.0), z_);
    }
    const double peak = std::abs(to - x_) / T * (smooth ? 0.5 * std::numbers::pi : 1.0);
    const double steps =
        std::max({20.0, peak * T / steps_.displacement, T / steps_.time, smooth ? 4.0 * peak / steps_.velocity : 0.0});
    const double h = 1.0 / std::ceil(steps);
    int at_one_time = 0;
    for (double s = 0.0; s < 1.0;) {
      const double end = 1.0 - s < 1.5 * h ? 1.0 : s + h;
      const Next whole = try_step(s, end);
      int guard = -1;
      double reached = end;
      Next taken = whole;
      if constexpr (switches) {
        if (negative_guard(end, whole.z) >= 0) {
          taken = up_to_switch(s, reached, guard);
          if (++at_one_time > 500) throw std::runtime_error("the law switches without end");
        }
      }
      if (reached > s + 1e-9 * h) at_one_time = 0;
      z_ = taken.z;
      work_ += taken.work;
      least_ = std::min(least_, work_);
      s = reached;
      const Input<double> in = at(s);
      if (watch) watch(in, mode_, z_);
      if constexpr (switches) {
        if (guard >= 0) {
          ++events_;
          if (switching) switching(in, mode_, z_, guard);
          mode_ = law_.next(in, mode_, std::span<double>(z_), guard);
        }
      }
    }
    x_ = to;
  }

  struct Next {
    std::vector<double> z;
    double work;
  };

  Next try_step(double from, double to) {
    const std::size_t n = z_.size();
    const double h = (to - from) * T_, part[] = {0.0, 0.5, 0.5, 1.0}, weight[] = {1.0, 2.0, 2.0, 1.0};
    Next next{z_, 0.0};
    std::vector<double> z = z_, dz(n, 0.0);
    for (int k = 0; k < 4; ++k) {
      if (k > 0)
        for (std::size_t i = 0; i < n; ++i) z[i] = z_[i] + part[k] * h * dz[i];
      const Input<double> in = at(from + part[k] * (to - from));
      law_.rate(in, mode_, z, dz);
      for (std::size_t i = 0; i < n; ++i) next.z[i] += weight[k] / 6.0 * h * dz[i];
      next.work += weight[k] / 6.0 * h * law_.output(in, mode_, z) * in.v;
    }
    return next;
  }

  /// Index of the first negative guard, or -1.
  int negative_guard(double s, const std::vector<double>& z) {
    guards_.assign(static_cast<std::size_t>(law_.guards(mode_)), 0.0);
    law_.guard(at(s), mode_, z, guards_);
    for (std::size_t k = 0; k < guards_.size(); ++k)
      if (guards_[k] < 0.0) return static_cast<int>(k);
    return -1;
  }

  Next up_to_switch(double from, double& to, int& guard) {
    double low = from, high = to;
    guard = negative_guard(from, z_);
    if (guard >= 0) {
      to = from;
      return {z_, 0.0};
    }
    for (int k = 0; k < 80 && high - low > 2e-16 * high; ++k) {
      const double middle = 0.5 * (low + high);
      (negative_guard(middle, try_step(from, middle).z) >= 0 ? high : low) = middle;
    }
    Next next = try_step(from, to = high);
    guard = negative_guard(to, next.z);
    return next;
  }

  Law law_;
  MarchSteps steps_;
  Mode mode_;
  std::vector<double> z_, guards_;
  double x_ = 0.0, from_ = 0.0, to_ = 0.0, T_ = 1.0, work_ = 0.0, least_ = 0.0;
  bool smooth_ = true, begun_ = false;
  long events_ = 0;
};

}  // namespace limcycle::test
