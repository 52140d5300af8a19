/// @file
/// RODAS5P with dense output: the state at any time, not only at the ends of steps.
#pragma once

#include <boost/numeric/odeint/stepper/stepper_categories.hpp>
#include <utility>

#include "limcycle/analysis/motion/steppers/controlled_rodas5p.hpp"
#include "limcycle/analysis/motion/steppers/dense_segment.hpp"

namespace limcycle {

/// Odeint's dense output stepper on ControlledRodas5p.
class DenseRodas5p {
 public:
  using controlled_stepper_type = ControlledRodas5p;
  using stepper_type = Rodas5p;
  using state_type = State;
  using deriv_type = State;
  using value_type = double;
  using time_type = double;
  using order_type = Rodas5p::order_type;
  using stepper_category = boost::numeric::odeint::dense_output_stepper_tag;

  explicit DenseRodas5p(ControlledRodas5p stepper) : stepper_(std::move(stepper)) {}

  /// Starts (again) from (x0, t0) with dt0 the first step to try. Call it also when the system changes.
  void initialize(const State& x0, double t0, double dt0);

  /// Takes one step, retried with shorter lengths as needed, and returns its ends. Throws odeint::step_adjustment_error
  /// once the step no longer advances the time; the state before the step is then kept.
  template <class System>
  std::pair<double, double> do_step(System&& system) {
    double t = t_;
    double dt = dt_;
    while (stepper_.try_step(system, x_, t, new_x_, dt) != ControlledRodas5p::Result::success) require_progress(t, dt);
    return accept(t, dt);
  }

  /// State at t inside the last step. Throws std::invalid_argument outside it (before the first step: anywhere but t0).
  void calc_state(double t, State& x) const { segment_.at(t, x); }
  /// Interpolant of the last step.
  const DenseSegment& segment() const { return segment_; }

  const State& current_state() const { return x_; }
  double current_time() const { return t_; }
  const State& previous_state() const { return segment_.first_; }
  double previous_time() const { return segment_.start_; }
  /// Length proposed for the next step.
  double current_time_step() const { return dt_; }

  const ControlledRodas5p& controlled_stepper() const { return stepper_; }

 private:
  static void require_progress(double t, double dt);
  std::pair<double, double> accept(double t, double dt);

  ControlledRodas5p stepper_;
  DenseSegment segment_;
  State x_, new_x_;
  double t_ = 0;
  double dt_ = 0;
};

}  // namespace limcycle
