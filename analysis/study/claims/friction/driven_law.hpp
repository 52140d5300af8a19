#pragma once
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// A law driven at a prescribed velocity: Runge-Kutta of order 4 with equal steps, switches located by bisection. It is
/// deliberately simple and shares only the equations of the law with the methods that claims test.
class DrivenLaw {
 public:
  /// Without history, with the sign of `velocity` as the coming direction.
  explicit DrivenLaw(Element law, double velocity = 1.0);

  /// Continues for `duration` (s) in `steps` steps, with v(t) of the time since the beginning of this stretch. It must
  /// be smooth there. Throws std::domain_error if the state is no longer finite or the law does not stop switching.
  void go(const std::function<double(double)>& velocity, double duration, int steps);
  /// At constant velocity over a distance >= 0, m.
  void slide(double velocity, double distance, int steps);
  /// At constant velocity, in steps of `step` (m), until the force has reached a level; the last step is cut by
  /// bisection. False if it has not within `most` steps.
  bool slide_to_force(double velocity, double force, double step, int most = 1000000);

  double x() const { return x_; }
  double force() const { return law_.output(now_, mode_, z_); }
  /// Work done on the law since the beginning, J.
  double work() const { return work_; }
  const std::vector<double>& state() const { return z_; }
  std::vector<double>& state() { return z_; }

  /// Called after every step, before the next one: time since the beginning of the stretch.
  std::function<void(double)> watch;

 private:
  struct Moved {
    std::vector<double> z;
    double x = 0.0, work = 0.0;
  };
  using Velocity = std::function<double(double)>;
  void move(const Velocity& velocity, double t, double h, Moved& end);
  int broken_guard(const Input<double>& in, std::span<const double> z);
  void settle(const Input<double>& in);
  void step(const Velocity& velocity, double t, double h);
  Input<double> at(double x, double v) const;

  Element law_;
  Mode mode_{};
  std::vector<double> z_;
  Input<double> now_;
  double x_ = 0.0, work_ = 0.0, direction_ = 1.0;
  std::array<std::vector<double>, 4> slope_;  // workspace of a step
  std::vector<double> stage_, guards_;
  Moved next_, tried_;
};

}  // namespace limcycle
