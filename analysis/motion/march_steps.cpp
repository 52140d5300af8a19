#include <algorithm>
#include <cmath>
#include <utility>

#include "limcycle/analysis/motion/march_stepper.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"

/// @file
/// Single steps of a march: the stepper in use, ever shorter tries, and repeats with other lengths.

namespace limcycle {
namespace {

constexpr int most_at_floor = 10'000;  ///< exact steps rejected at the shortest length: no progress

/// The field as Odeint's explicit steppers require it, and with its Jacobian as the implicit one does.
auto right_side(LoopField& field) {
  return [&field](const State& x, State& dx, double t) { field.rate(x, dx, t); };
}
auto implicit_system(LoopField& field) {
  return std::pair(right_side(field), [&field](const State& x, Eigen::MatrixXd& J, double t, State& dfdt) {
    field.jacobian(x, J, t, dfdt);
  });
}

AnyStepper make_stepper(StepperKind kind, const ErrorWeights& w, LoopField& field) {
  switch (kind) {
    case StepperKind::exact:
      return ExactStepper{AffineFlow(field), typical_sizes(field.loop())};
    case StepperKind::dopri5:
      return ExplicitStepper<ControlledDopri5>{make_dopri5(w)};
    case StepperKind::fehlberg78:
      return ExplicitStepper<ControlledFehlberg78>{make_fehlberg78(w)};
    case StepperKind::cash_karp54:
      return ExplicitStepper<ControlledCashKarp54>{make_cash_karp54(w)};
    default:
      return ControlledRodas5p(w);
  }
}

}  // namespace

March::Stepper::Stepper(StepperKind kind, const ErrorWeights& weights, LoopField& field)
    : moving(make_stepper(kind, weights, field)) {
  if (kind == StepperKind::rodas5p && field.has_clocks()) clocked.emplace(ClockedDopri5{{make_dopri5(weights)}});
}

void March::Stepper::restart() {
  const auto fresh = []<class S>(S& s) {
    if constexpr (requires { s.reset(); }) s.reset();
    if constexpr (requires { s.controlled.reset(); }) s.controlled.reset();
  };
  std::visit(fresh, moving);
  if (waiting) std::visit(fresh, *waiting);
}

void March::wait_patiently() {
  if (!steep_ || kind_ == StepperKind::exact) return;
  const Loop& loop = field_.loop();
  stepper_->waiting =
      make_stepper(StepperKind::rodas5p, loop_weights(loop, weights_.rtol, typical_sizes(loop), true), field_);
}

/// Hairer, Norsett, Wanner I (1993), section II.4: a first step that changes the state by a hundredth of itself.
double March::first_dt() {
  double size = 0.0, speed = 0.0;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double scale = weights_.atol[i] + weights_.rtol * weights_.size(i, x_[i]);
    size = std::max(size, std::abs(x_[i]) / scale);
    speed = std::max(speed, std::abs(step_.dx0[i]) / scale);
  }
  const double h = size > 1e-5 && speed > 1e-5 ? 0.01 * size / speed : 1e-6 * weights_.time;
  const double least = 1e-12 * (weights_.time + std::abs(t_));  // a motion at rest may reach such times
  return std::clamp(h, least, std::max(least, weights_.time));
}

/// An exact step; fails if the cubic through its ends is too far from the motion in the middle. Unless it must end at a
/// given time its length is a power of two, whose exponential is kept.
bool March::try_exact(double& dt) {
  auto& exact = std::get<ExactStepper>(stepper_->moving);
  const int longest = 60 + static_cast<int>(std::log2(weights_.time));
  const int k = std::min(longest, static_cast<int>(std::floor(std::log2(dt))));  // at rest steps grow without limit
  const double h = truncated_ ? dt : std::ldexp(1.0, k);
  exact.length = h;
  exact.power = truncated_ ? std::nullopt : std::optional(k);
  exact.flow.move(h, x_, step_.x1);
  exact.flow.move(0.5 * h, x_, exact.middle);
  field_.rate(step_.x1, exact.rate_at_end, t_ + h);
  double error = 0.0;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double cubic = 0.5 * (x_[i] + step_.x1[i]) + 0.125 * h * (step_.dx0[i] - exact.rate_at_end[i]);
    const double size = std::max(std::abs(x_[i]), 1e-3 * exact.tolerance[i]);
    const double miss = std::abs(cubic - exact.middle[i]) / (1e-6 * size);
    error = std::isnan(miss) ? infinite : std::max(error, miss);  // overflow: too long
  }
  const double factor = std::clamp(0.9 * std::pow(std::max(error, 1e-12), -0.25), 0.125, 4.0);
  const bool shortest = h <= 1e-14 * std::max(weights_.time, std::abs(t_));
  exact.at_floor = error > 1.0 && shortest ? exact.at_floor + 1 : 0;
  if (error > 1.0 && (!shortest || exact.at_floor > most_at_floor)) {
    dt = shortest ? 0.0 : std::min(0.5, factor) * h;
    truncated_ = false;
    return false;
  }
  dt = factor * h;
  step_.t1 = t_ + h;
  return true;
}

bool March::try_step(double& dt) {
  step_.x1 = x_;
  step_.t1 = t_;
  if (kind_ == StepperKind::exact) {
    if (!try_exact(dt)) return false;
    field_.keep_held(step_.x0, step_.x1);
    return is_finite(step_.x1);
  }
  const double tried = dt;
  if (stepper_->uses_clocked()) {
    if (try_clocked(dt)) return true;
    step_.x1 = x_;
    step_.t1 = t_;
    dt = tried;
  }
  const auto result = std::visit(
      [&]<class S>(S& stepper) {
        if constexpr (std::is_same_v<S, ExactStepper>)
          return boost::numeric::odeint::fail;
        else if constexpr (std::is_same_v<S, ControlledRodas5p>)
          return stepper.try_step(implicit_system(field_), step_.x0, step_.dx0, step_.t1, step_.x1, dt);
        else
          return stepper.controlled.try_step(right_side(field_), step_.x1, step_.t1, dt);
      },
      stepper_->any());
  if (result != boost::numeric::odeint::success) return false;
  field_.keep_held(step_.x0, step_.x1);
  if (is_finite(step_.x1)) return true;
  dt = 0.1 * tried;  // a NaN that the error estimate did not show
  return false;
}

/// A step of ClockedDopri5.
bool March::try_clocked(double& dt) {
  auto& clocked = *stepper_->clocked;
  const auto result =
      clocked.controlled.try_step(right_side(field_), step_.x0, step_.dx0, step_.t1, step_.x1, clocked.rate_at_end, dt);
  if (result == boost::numeric::odeint::success) field_.keep_held(step_.x0, step_.x1);
  if (result == boost::numeric::odeint::success && is_finite(step_.x1)) {
    clocked.pause = ClockedDopri5::shortest_pause;
    return true;
  }
  clocked.refused();
  return false;
}

/// The same step with length h: a whole step of the method, not its interpolant.
void March::repeat(double h, State& out) {
  if (stepper_->uses_clocked()) {
    stepper_->clocked->plain.do_step(right_side(field_), step_.x0, step_.dx0, step_.t0, out,
                                     stepper_->clocked->rate_at_end, h);
    return field_.keep_held(step_.x0, out);
  }
  std::visit(
      [&]<class S>(S& stepper) {
        if constexpr (std::is_same_v<S, ExactStepper>) {
          stepper.length = h;
          stepper.power.reset();
          stepper.flow.move(h, step_.x0, out);
        } else if constexpr (std::is_same_v<S, ControlledRodas5p>) {
          stepper.stepper().repeat_step(implicit_system(field_), out, h, repeat_error_);
        } else {
          if constexpr (requires { stepper.plain.reset(); }) stepper.plain.reset();
          stepper.plain.do_step(right_side(field_), step_.x0, step_.t0, out, h);
        }
      },
      stepper_->any());
  field_.keep_held(step_.x0, out);
}

/// A few roundings of the time.
double March::shortest_step() const { return 1e-15 * std::max(std::abs(t_), 1e-12 * weights_.time); }

/// Ever shorter steps until the error allows one.
Status March::accepted_step(double& dt) {
  const double shortest = shortest_step();
  while (!try_step(dt)) {
    if (dt > shortest) continue;
    if (!is_finite(step_.x1)) return Status::not_finite;
    return step_at_floor(shortest, dt) ? Status::converged : Status::stalled;
  }
  at_floor_ = 0;
  return step_.t1 == t_ ? Status::stalled : Status::converged;  // Odeint's explicit steppers accept a step of no length
}

/// True if an implicit step that ends at an event is as accurate as the longer one that found it. At a bristle a
/// million times as fast as the step it may not be, and the event false.
bool March::ends_within_error() {
  constexpr double most = 10.0;  // times the tolerance
  const double h = step_.t1 - step_.t0;
  const bool is_explicit = kind_ != StepperKind::rodas5p || stepper_->uses_clocked();
  if (is_explicit || h <= 8.0 * shortest_step()) return true;
  return weights_.norm(step_.x0, step_.x1, repeat_error_) <= most;
}

/// A step near the rounding of time, whatever its error: on a curve of infinite slope a body that breaks away after a
/// long wait changes its velocity by more than the tolerance within that rounding.
bool March::step_at_floor(double shortest, double& dt) {
  constexpr int most = 50;
  if (!steep_ || kind_ == StepperKind::exact || ++at_floor_ > most) return false;
  const double h = 4.0 * shortest;
  repeat(h, step_.x1);
  step_.t1 = t_ + h;
  dt = 2.0 * h;
  return is_finite(step_.x1);
}

}  // namespace limcycle
