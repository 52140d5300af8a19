/// @file
/// RODAS5P with its step size chosen for a tolerance.
#pragma once

#include <boost/numeric/odeint/stepper/controlled_step_result.hpp>
#include <boost/numeric/odeint/stepper/stepper_categories.hpp>

#include "limcycle/analysis/motion/error_weights.hpp"
#include "limcycle/analysis/motion/steppers/rodas5p.hpp"
#include "limcycle/analysis/motion/steppers/step_size.hpp"

namespace limcycle {

/// Odeint's controlled stepper on Rodas5p. A step is accepted if its weighted error (largest over the components) is at
/// most 1; a NaN or an infinity anywhere rejects it. After a rejection f and J at the start of the step are kept.
class ControlledRodas5p {
 public:
  using stepper_type = Rodas5p;
  using state_type = State;
  using deriv_type = State;
  using value_type = double;
  using time_type = double;
  using order_type = Rodas5p::order_type;
  using stepper_category = boost::numeric::odeint::controlled_stepper_tag;
  using Result = boost::numeric::odeint::controlled_step_result;

  /// Throws std::invalid_argument unless the weights are valid and max_dt is finite and at least 0 (0: no limit).
  explicit ControlledRodas5p(ErrorWeights weights, double max_dt = 0);

  /// Tries a step of length dt (shortened to max_dt) from (x, t). `success`: x and t are those at its end and dt is the
  /// length proposed for the next step. `fail`: x and t are as before and dt is shorter, down to where t + dt == t,
  /// which always fails: the caller must then stop (Odeint's integrate functions throw step_adjustment_error after 500
  /// failures in a row). Throws std::invalid_argument if dt is 0 or not finite or the size of x differs from that of
  /// the weights.
  template <class System>
  Result try_step(System&& system, State& x, double& t, double& dt) {
    return try_step(system, x, t, x, dt);
  }

  /// The same with the new state in xout, which a failed step leaves alone; xout may be x.
  template <class System>
  Result try_step(System&& system, const State& x, double& t, State& xout, double& dt) {
    return attempt(system, x, t, xout, dt, [&] { stepper_.do_step(system, x, t, new_x_, dt, error_); });
  }

  /// The same with the rate at (x, t) given, as Odeint's explicit steppers take it.
  template <class System>
  Result try_step(System&& system, const State& x, const State& dxdt, double& t, State& xout, double& dt) {
    return attempt(system, x, t, xout, dt, [&] { stepper_.do_step(system, x, dxdt, t, new_x_, dt, error_); });
  }

  /// Discards the previous step. Call it whenever the system changes (mode, parameters) or the state jumps: otherwise f
  /// and J of the old system would be used again after a failure from the same (x, t), and the trend of the error would
  /// continue.
  void reset();

  /// Interpolant of the last step, for a step that was accepted: valid between its ends. Any later step (also one that
  /// fails) replaces it here, not in `segment`.
  void interpolant(DenseSegment& segment) const { stepper_.interpolant(segment); }

  /// Weighted error of the last step tried.
  double last_error() const { return last_error_; }
  const ErrorWeights& weights() const { return weights_; }
  double max_dt() const { return max_dt_; }

  /// The error stepper, e.g. to repeat a step with a length that lands on an event.
  Rodas5p& stepper() { return stepper_; }
  const Rodas5p& stepper() const { return stepper_; }

 private:
  /// A step, by `first` unless it has just failed.
  template <class System, class First>
  Result attempt(System& system, const State& x, double& t, State& xout, double& dt, const First& first) {
    dt = admit(x, dt);
    if (retries(x, t)) {
      stepper_.repeat_step(system, new_x_, dt, error_);
    } else {
      first();
    }
    const Result result = judge(x, t, dt);
    if (result == Result::success) xout = new_x_;
    return result;
  }

  double admit(const State& x, double dt) const;
  bool retries(const State& x, double t) const;
  Result judge(const State& x, double& t, double& dt);

  ErrorWeights weights_;
  double max_dt_;
  Rodas5p stepper_;
  StepSizeControl step_size_;
  State new_x_, error_;
  double last_error_ = 0;
  bool failed_ = false;
};

}  // namespace limcycle
