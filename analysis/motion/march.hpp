#pragma once
#include <cmath>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "limcycle/analysis/motion/clock_wait.hpp"
#include "limcycle/analysis/motion/error_weights.hpp"
#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/analysis/motion/steppers/stepper_kind.hpp"
#include "limcycle/analysis/status.hpp"

namespace limcycle {

/// A surface C X = level in the space of the linear states, crossed in one direction (+1 upwards, -1 downwards).
struct Section {
  Eigen::RowVectorXd C;
  double level = 0.0;
  int direction = 1;
  double value(const State& x) const {
    return direction * ((C * Eigen::Map<const Eigen::VectorXd>(x.data(), C.size())).value() - level);
  }
  /// True on the side that the crossing comes from, by more than the rounding of a point that was landed on the
  /// surface.
  bool before(const State& x) const {
    const double size =
        std::abs(level) + C.cwiseAbs() * Eigen::Map<const Eigen::VectorXd>(x.data(), C.size()).cwiseAbs();
    return value(x) < -1e-12 * size;
  }
};

/// One accepted step, in which the field is smooth.
struct Step {
  double t0 = 0.0, t1 = 0.0;
  State x0, x1, dx0, dx1;
  std::optional<std::size_t> switched;  ///< the element that switched at t1
  bool by_clock = false;                ///< and that by its own clock
  bool on_section = false;              ///< t1 is a crossing of the section
  /// A body arrived at v = 0 at t1 with no deceleration but roundings: it crept towards a point at which its forces
  /// balance, which takes for ever, and only roundings made it stop or turn.
  bool crept = false;
  /// d(state after the step, and after the switch at its end)/dx0, if the march tracks it; empty if a switch was not
  /// crossed transversally.
  Eigen::MatrixXd transition;

  /// State at t0 + theta (t1 - t0), 0 <= theta <= 1: cubic through values and rates, error O(h^4).
  void interpolate(double theta, State& x) const;
};

/// Marches a loop step by step through located events: no step spans a switch, and no event is skipped. With
/// StepperKind::exact a step has no error; its length is chosen so that the cubic through its ends is accurate to 1e-6
/// of the sizes, and no event between them is missed. An event is located by repeating the step with other lengths
/// until the guard is zero to rounding, so its time is as accurate as the stepper itself. Events that accumulate end
/// the march with Status::chattering.
class March {
 public:
  March(LoopField& field, StepperKind kind, ErrorWeights weights);
  ~March();
  March(March&&) noexcept;
  March& operator=(March&&) = delete;

  /// Starts at (x, t) in the field's present modes. `section`: also stop at its crossings; a start on it does not
  /// count.
  void begin(State x, double t, std::optional<Section> section = {});
  /// Discards the previous run, counts and step size included, so that the next one is the same as in a new march.
  void reset();
  /// One accepted step, not beyond t_end. Any status but converged means that the march cannot continue.
  Status step(double t_end);

  const Step& last() const { return step_; }
  /// The state at a share of the last step, unless that ended with a switch: by a whole step of the method.
  void within(double share, State& x) {
    x.resize(x_.size());
    repeat(share * (step_.t1 - step_.t0), x);
  }
  const State& x() const { return x_; }
  double t() const { return t_; }
  long steps() const { return steps_; }
  long events() const { return events_; }
  StepperKind kind() const { return kind_; }
  void limit_step(double dt_max) { dt_max_ = dt_max; }
  /// For a curve with infinite slope at rest, which explicit steps with a narrow tolerance of the velocity pass:
  /// implicit steps with the usual tolerances while a body is stuck. It may wait for an integrator many times as long
  /// as the fastest pole permits an explicit step. StepperKind::automatic does so by itself.
  void wait_patiently();
  /// Switches the computation of Step::transition on or off (autonomous loops only). Steps are then also short enough
  /// for their derivative.
  void track(bool wanted = true) { tracks_ = wanted; }

 private:
  struct Stepper;  ///< a controlled stepper of Odeint or limcycle, or the exact flow

  bool creeps(std::size_t guard) const;
  bool try_step(double& dt);
  bool try_exact(double& dt);
  bool try_clocked(double& dt);
  double shortest_step() const;
  Status accepted_step(double& dt);
  bool step_at_floor(double shortest, double& dt);
  bool ends_within_error();
  Eigen::MatrixXd smooth_transition();
  bool is_linearised();
  std::optional<double> passage_of_layer();
  void repeat(double h, State& out);
  double first_dt();
  bool leaves_at_once(std::size_t guard, double fraction);
  bool negative_within(const std::vector<double>& at_start, double& from, double& to, std::size_t& guard);
  double event_value(std::size_t guard, const State& x, double t);
  double value_between(std::size_t guard, double fraction);
  double crossing(std::size_t guard, double from, double to);
  std::size_t first_of_candidates(const std::vector<double>& at_start, double from, double to);
  double locate(std::size_t guard, double from, double to);
  bool happens(std::size_t guard, double at, double to);
  void end_at(double h);
  Status land(std::size_t guard, double tried);
  Status land_by_clock(double tried);
  Status wait_for_clock(double due, double t_end);
  std::vector<std::vector<double>> guards_by_element();
  std::optional<std::size_t> passed_by_jump(const std::vector<std::vector<double>>& before);
  bool release(SwitchSlopes& first, std::vector<std::vector<double>> before);

  /// The range of rubbing velocities, |v| < edge, in which a friction law changes about rest.
  struct Layer {
    std::size_t element;
    double edge;
  };

  LoopField& field_;
  StepperKind kind_;
  std::unique_ptr<Stepper> stepper_;
  ErrorWeights weights_;
  std::optional<Section> section_;
  std::optional<ClockWait> wait_;  ///< of a loop with sampled controllers
  bool armed_ = false;
  State x_, work_, repeat_error_;
  double t_ = 0.0, dt_ = 0.0, dt_max_ = infinite;
  bool fresh_ = true, tracks_ = false, truncated_ = false, steep_ = false;
  long steps_ = 0, events_ = 0;
  int at_floor_ = 0;  ///< steps in a row, see step_at_floor
  int halvings_ = 0;  ///< of the present step, for a layer or its derivative
  std::vector<Layer> layers_;
  Step step_;
  std::deque<double> event_times_;
  std::vector<double> guards_start_, guards_end_, guards_mid_;
  std::vector<std::size_t> candidates_;
};

}  // namespace limcycle
