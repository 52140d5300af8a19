#include "limcycle/analysis/motion/march.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <variant>

#include "limcycle/analysis/motion/field/affine_flow.hpp"
#include "limcycle/analysis/motion/steppers/controlled_rodas5p.hpp"
#include "limcycle/analysis/motion/steppers/explicit_steppers.hpp"
#include "limcycle/analysis/motion/steppers/transition.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"

namespace limcycle {
namespace {

constexpr std::array<std::pair<StepperKind, std::string_view>, 6> names{{{StepperKind::automatic, "auto"},
                                                                         {StepperKind::exact, "exact"},
                                                                         {StepperKind::rodas5p, "rodas5p"},
                                                                         {StepperKind::dopri5, "dopri5"},
                                                                         {StepperKind::fehlberg78, "fehlberg78"},
                                                                         {StepperKind::cash_karp54, "cash-karp54"}}};

/// Matrix exponentials instead of a stepper.
struct ExactStepper {
  AffineFlow flow;
  State tolerance;         ///< permitted error of the cubic through the ends of a step
  Eigen::MatrixXd last{};  ///< exponential of the last step, tried or repeated
  State rate_at_end, middle;
  int at_floor = 0;  ///< successive steps that were too long although the shortest possible
};

using AnyStepper =
    std::variant<ControlledRodas5p, ControlledDopri5, ControlledFehlberg78, ControlledCashKarp54, ExactStepper>;

AnyStepper make(StepperKind kind, const ErrorWeights& w, LoopField& field) {
  switch (kind) {
    case StepperKind::exact:
      return ExactStepper{AffineFlow(field), typical_sizes(field.loop()), {}, {}, {}};
    case StepperKind::dopri5:
      return make_dopri5(w);
    case StepperKind::fehlberg78:
      return make_fehlberg78(w);
    case StepperKind::cash_karp54:
      return make_cash_karp54(w);
    default:
      return ControlledRodas5p(w);
  }
}

constexpr double longest_step = 1e15;  ///< relative to that of the motion
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

}  // namespace

StepperKind stepper_kind(const std::string& name) {
  for (const auto& [kind, text] : names)
    if (text == name) return kind;
  throw std::invalid_argument("stepper must be auto, exact, rodas5p, dopri5, fehlberg78 or cash-karp54, got " + name);
}

std::string_view to_string(StepperKind kind) { return names[static_cast<std::size_t>(kind)].second; }

StepperKind choose_stepper(const Loop& loop, double rtol, bool driven) {
  if (!driven && AffineFlow::applies(loop)) return StepperKind::exact;
  const bool bristle = std::ranges::any_of(loop.elements, [](const auto& element) {
    const bool band = element.drive_band() > 0.0 && element.needs_drive();  // a stiff layer at rest
    return band || (element.states() > 0 && std::isfinite(element.scales().displacement));
  });
  // A body that truly sticks waits as long as an integrator needs, many times the slowest time constant of the free
  // motion, while the fastest poles (the filter of a derivative) limit the step of an explicit stepper.
  const bool sticks = std::ranges::any_of(loop.elements, [](const auto& element) { return element.may_stick(); });
  // The Jacobian of a curve that begins with infinite slope is unbounded where the body stops and breaks away: implicit
  // steps shrink to nothing there, explicit ones pass.
  constexpr double too_steep = 0.6;
  const bool steep =
      std::ranges::any_of(loop.elements, [](const auto& element) { return element.steep_exponent() < too_steep; });
  const auto moduli = pole_moduli(loop);
  const double stiff = steep ? 5000.0 : sticks ? 20.0 : 200.0;
  if (bristle || (!moduli.empty() && moduli.back() > stiff * moduli.front())) return StepperKind::rodas5p;
  return explicit_stepper(rtol);
}

StepperKind explicit_stepper(double rtol) { return rtol < 1e-8 ? StepperKind::fehlberg78 : StepperKind::dopri5; }

void Step::interpolate(double theta, State& x) const {
  const double h = t1 - t0, left = 1.0 - theta;
  x.resize(x0.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double chord = x1[i] - x0[i];
    x[i] = left * x0[i] + theta * x1[i] -
           theta * left * ((1.0 - 2.0 * theta) * chord + h * (theta * dx1[i] - left * dx0[i]));
  }
}

struct March::Stepper {
  AnyStepper any;
};

March::~March() = default;
March::March(March&&) noexcept = default;

March::March(LoopField& field, StepperKind kind, ErrorWeights weights)
    : field_(field),
      kind_(kind == StepperKind::automatic ? choose_stepper(field.loop(), weights.rtol, field.driven()) : kind),
      stepper_(std::make_unique<Stepper>(Stepper{make(kind_, weights, field)})),
      weights_(std::move(weights)) {
  if (kind_ == StepperKind::exact && (field.driven() || !AffineFlow::applies(field.loop())))
    throw std::invalid_argument("simulate.stepper exact is for loops of piecewise affine elements without signals");
}

void March::begin(State x, double t, std::optional<Section> section) {
  x_ = std::move(x);
  t_ = t;
  section_ = std::move(section);
  armed_ = false;
  fresh_ = true;
  step_.switched.reset();
  step_.on_section = false;
  event_times_.clear();
}

void March::reset() {
  dt_ = 0.0;
  steps_ = events_ = 0;
}

/// Hairer, Norsett, Wanner I (1993), section II.4: a first step that changes the state by a hundredth of itself.
double March::first_dt() {
  double size = 0.0, speed = 0.0;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double scale = weights_.atol[i] + weights_.rtol * std::abs(x_[i]);
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
  auto& exact = std::get<ExactStepper>(stepper_->any);
  const int longest = 60 + static_cast<int>(std::log2(weights_.time));
  const int k = std::min(longest, static_cast<int>(std::floor(std::log2(dt))));  // at rest steps grow without limit
  const double h = truncated_ ? dt : std::ldexp(1.0, k);
  exact.last = truncated_ ? exact.flow.over(h) : exact.flow.over_power(k);
  AffineFlow::apply(exact.last, x_, step_.x1);
  AffineFlow::apply(truncated_ ? exact.flow.over(0.5 * h) : exact.flow.over_power(k - 1), x_, exact.middle);
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
    if (try_exact(dt)) return is_finite(step_.x1);
    return false;
  }
  const double tried = dt;
  const auto result = std::visit(
      [&]<class S>(S& stepper) {
        if constexpr (std::is_same_v<S, ExactStepper>)
          return boost::numeric::odeint::fail;
        else if constexpr (std::is_same_v<S, ControlledRodas5p>)
          return stepper.try_step(implicit_system(field_), step_.x0, step_.dx0, step_.t1, step_.x1, dt);
        else
          return stepper.try_step(right_side(field_), step_.x1, step_.t1, dt);
      },
      stepper_->any);
  if (result != boost::numeric::odeint::success) return false;
  if (is_finite(step_.x1)) return true;
  dt = 0.1 * tried;  // a NaN that the error estimate did not show
  return false;
}

/// The same step with length h: a whole step of the method, not its interpolant.
void March::repeat(double h, State& out) {
  std::visit(
      [&]<class S>(S& stepper) {
        if constexpr (std::is_same_v<S, ExactStepper>) {
          stepper.last = stepper.flow.over(h);
          AffineFlow::apply(stepper.last, step_.x0, out);
        } else if constexpr (std::is_same_v<S, ControlledRodas5p>) {
          stepper.stepper().repeat_step(implicit_system(field_), out, h, unused_);
        } else {
          typename S::stepper_type fresh;  // Odeint's own one keeps the rate of another point
          fresh.do_step(right_side(field_), step_.x0, step_.t0, out, h);
        }
      },
      stepper_->any);
}

/// Derivative of the end of the present step over its start, before any switch.
Eigen::MatrixXd March::smooth_transition() {
  const auto n = static_cast<Eigen::Index>(x_.size());
  if (step_.t1 == step_.t0) return Eigen::MatrixXd::Identity(n, n);
  if (kind_ == StepperKind::exact) return std::get<ExactStepper>(stepper_->any).last.topLeftCorner(n, n);
  return transition(field_, step_);
}

Status March::step(double t_end) {
  if (t_ >= t_end) return Status::converged;
  if (fresh_)
    field_.rate(x_, step_.dx0, t_);
  else
    std::swap(step_.dx0, step_.dx1);  // the previous step ended here
  step_.t0 = t_;
  step_.x0 = x_;
  step_.switched.reset();
  step_.on_section = false;
  if (!is_finite(x_) || !is_finite(step_.dx0)) return Status::not_finite;
  field_.guards(x_, t_, guards_start_);
  if (fresh_) {
    std::visit(
        [](auto& s) {
          if constexpr (requires { s.reset(); }) s.reset();
        },
        stepper_->any);
    dt_ = dt_ > 0.0 ? std::min(dt_, first_dt()) : first_dt();
    fresh_ = false;
  }
  dt_ = std::min(dt_, longest_step * weights_.time);  // at rest steps grow without limit
  double dt = std::min({dt_, dt_max_, t_end - t_});
  bool shortened = dt < dt_;  // by the requested end, not by the error: the next step may be as long as before
  truncated_ = dt == t_end - t_;
  while (!try_step(dt)) {
    shortened = false;
    if (!(dt > 1e-15 * std::max(std::abs(t_), 1e-12 * weights_.time)))
      return is_finite(step_.x1) ? Status::stalled : Status::not_finite;
  }
  if (step_.t1 == t_) return Status::stalled;  // Odeint's explicit steppers accept a step that does not move
  dt_ = shortened ? std::max(dt, dt_) : dt;
  ++steps_;
  field_.rate(step_.x1, step_.dx1, step_.t1);
  double from = 0.0, to = 1.0;
  std::size_t guard = 0;
  if (negative_within(guards_start_, from, to, guard)) return land(guard, locate(guard, from, to));
  if (tracks_) step_.transition = smooth_transition();
  x_ = step_.x1;
  t_ = step_.t1;
  if (section_ && section_->before(x_)) armed_ = true;
  return Status::converged;
}

}  // namespace limcycle
