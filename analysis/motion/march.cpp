#include "limcycle/analysis/motion/march.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

/// Norm of the rounding errors of the rate at the start of a step: those of the terms that it is the sum of, which
/// cancel where a body creeps. No shorter step makes them smaller.
double rounding_of_rate(LoopField& field, const Step& step, const Eigen::VectorXd& scale) {
  constexpr double rounding = 8.0 * std::numeric_limits<double>::epsilon();
  Eigen::MatrixXd jacobian(scale.size(), scale.size());
  State by_time;
  field.jacobian(step.x0, jacobian, step.t0, by_time);
  const Eigen::Map<const Eigen::VectorXd> x(step.x0.data(), scale.size());
  return rounding * (jacobian.cwiseAbs() * x.cwiseAbs()).cwiseQuotient(scale).norm();
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
  AnyStepper moving;
  std::optional<AnyStepper> waiting;  ///< see wait_patiently()
  bool waits = false;

  AnyStepper& any() { return waits ? *waiting : moving; }
};

March::~March() = default;
March::March(March&&) noexcept = default;

March::March(LoopField& field, StepperKind kind, ErrorWeights weights)
    : field_(field),
      kind_(kind == StepperKind::automatic ? choose_stepper(field.loop(), weights.rtol, field.driven()) : kind),
      stepper_(std::make_unique<Stepper>(Stepper{make(kind_, weights, field), {}})),
      weights_(std::move(weights)) {
  if (kind_ == StepperKind::exact && (field.driven() || !AffineFlow::applies(field.loop())))
    throw std::invalid_argument("simulate.stepper exact is for loops of piecewise affine elements without signals");
  constexpr double widths = 8.0;  // beyond, a Stribeck curve is flat or changes slowly
  const Loop& loop = field.loop();
  steep_ = has_infinite_slope(loop);
  if (kind == StepperKind::automatic) wait_patiently();
  for (std::size_t i = 0; i < loop.elements.size() && kind_ != StepperKind::exact; ++i)
    if (const double width = loop.elements[i].scales().velocity; loop.ports[i].rubs && std::isfinite(width))
      layers_.push_back({i, widths * width});
}

void March::wait_patiently() {
  if (!steep_ || kind_ == StepperKind::exact) return;
  const Loop& loop = field_.loop();
  stepper_->waiting = make(StepperKind::rodas5p, loop_weights(loop, weights_.rtol, typical_sizes(loop), true), field_);
}

void March::begin(State x, double t, std::optional<Section> section) {
  x_ = std::move(x);
  t_ = t;
  section_ = std::move(section);
  armed_ = false;
  fresh_ = true;
  step_.switched.reset();
  step_.on_section = step_.by_clock = step_.crept = false;
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
      stepper_->any());
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
          stepper.stepper().repeat_step(implicit_system(field_), out, h, repeat_error_);
        } else {
          typename S::stepper_type fresh;  // Odeint's own one keeps the rate of another point
          fresh.do_step(right_side(field_), step_.x0, step_.t0, out, h);
        }
      },
      stepper_->any());
}

/// Derivative of the end of the present step over its start, before any switch.
Eigen::MatrixXd March::smooth_transition() {
  const auto n = static_cast<Eigen::Index>(x_.size());
  if (step_.t1 == step_.t0) return Eigen::MatrixXd::Identity(n, n);
  if (kind_ == StepperKind::exact) return std::get<ExactStepper>(stepper_->moving).last.topLeftCorner(n, n);
  return transition(field_, step_);
}

/// Computes the derivative of the step. False if it does not carry the rate at the start of the step to that at its
/// end, as the derivative of a flow does: a layer that takes next to no time, such as that of a Stribeck curve about
/// rest, hardly moves the state, and a step that is accurate for the state may still pass over it.
bool March::is_linearised() {
  constexpr int most_halvings = 20;
  step_.transition = smooth_transition();
  const bool shortest = step_.t1 - step_.t0 <= 1e-14 * std::abs(step_.t1);
  if (kind_ == StepperKind::exact || steep_ || shortest || halvings_ >= most_halvings) return true;
  const auto n = static_cast<Eigen::Index>(x_.size());
  const Eigen::Map<const Eigen::VectorXd> before(step_.dx0.data(), n), after(step_.dx1.data(), n);
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    scale(i) = weights_.atol[k] + weights_.rtol * weights_.size(k, step_.x0[k]);
  }
  const double defect = (step_.transition * before - after).cwiseQuotient(scale).norm();
  const double rate = std::max(before.cwiseQuotient(scale).norm(), after.cwiseQuotient(scale).norm());
  return !(defect > 0.1 * std::sqrt(weights_.rtol) * rate) || defect <= rounding_of_rate(field_, step_, scale);
}

/// The time that the present step needs for a layer of a friction law that it enters, if the rest of the step is
/// longer. The error estimate of a step sees nothing of a layer that lies between its stages: such a step is halved.
std::optional<double> March::passage_of_layer() {
  std::optional<double> found;
  double first = 1.0;
  for (const Layer& layer : layers_) {
    const Port& port = field_.loop().ports[layer.element];
    const auto velocity = [&](const State& x) {
      return port.C_v.dot(Eigen::Map<const Eigen::RowVectorXd>(x.data(), port.C_v.size())) +
             port.c_v.dot(field_.loop().external);
    };
    const double v0 = velocity(step_.x0), v1 = velocity(step_.x1), sign = v0 < 0.0 ? -1.0 : 1.0;
    if (std::abs(v0) <= layer.edge || sign * v1 >= layer.edge) continue;
    double outside = 0.0, inside = 1.0;
    for (int i = 0; i < 20; ++i) {
      const double mid = 0.5 * (outside + inside);
      step_.interpolate(mid, work_);
      (sign * velocity(work_) >= layer.edge ? outside : inside) = mid;
    }
    const double h = step_.t1 - step_.t0, passage = layer.edge * h / std::abs(v1 - v0);
    if ((1.0 - inside) * h <= passage || inside >= 0.999 || inside >= first) continue;
    first = inside;
    found = passage;
  }
  return found;
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
  if (kind_ != StepperKind::rodas5p || h <= 8.0 * shortest_step()) return true;
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

Status March::step(double t_end) {
  if (t_ >= t_end) return Status::converged;
  if (fresh_)
    field_.rate(x_, step_.dx0, t_);
  else
    std::swap(step_.dx0, step_.dx1);  // the previous step ended here
  step_.t0 = t_;
  step_.x0 = x_;
  step_.switched.reset();
  step_.on_section = step_.crept = false;
  if (!is_finite(x_) || !is_finite(step_.dx0)) return Status::not_finite;
  field_.guards(x_, t_, guards_start_);
  if (fresh_) {
    stepper_->waits = stepper_->waiting &&
                      std::ranges::any_of(layers_, [this](const Layer& layer) { return field_.holds(layer.element); });
    std::visit(
        [](auto& s) {
          if constexpr (requires { s.reset(); }) s.reset();
        },
        stepper_->any());
    // A clock that switches changes a force a little, after a step that was accurate: the next may be as long.
    if (!step_.by_clock || dt_ == 0.0) dt_ = dt_ > 0.0 ? std::min(dt_, first_dt()) : first_dt();
    dt_ = std::max(dt_, 2.0 * shortest_step());  // two switches at one time leave no length
    fresh_ = false;
  }
  step_.by_clock = false;
  dt_ = std::min(dt_, longest_step * weights_.time);  // at rest steps grow without limit
  constexpr double just_before = 1.0 - 1e-14;         // so that the guard of the clock has not turned negative
  const double due = just_before * field_.due(x_);
  if (due < 16.0 * shortest_step()) return land_by_clock(0.0);
  const auto lasts = [](double guard) { return guard > 0.0; };
  if (due <= t_end - t_ && field_.only_clocks_run(step_.dx0) && std::ranges::all_of(guards_start_, lasts))
    return wait_for_clock(due);
  double dt = std::min({dt_, dt_max_, t_end - t_, due});
  bool shortened = dt < dt_;  // by the requested end, not by the error: the next step may be as long as before
  truncated_ = dt == t_end - t_ || dt == due;
  double within_layer = infinite;
  for (halvings_ = 0;; ++halvings_, dt = 0.5 * (step_.t1 - step_.t0)) {
    const double tried = dt;
    if (const Status status = accepted_step(dt); status != Status::converged) return status;
    if (step_.t1 != t_ + tried) shortened = false;  // a difference of times would be rounded
    const double length = step_.t1 - step_.t0;
    field_.rate(step_.x1, step_.dx1, step_.t1);
    const auto passage = passage_of_layer();
    if (passage && length > 4.0 * shortest_step()) {  // after a wait of 1e9 s no shorter step can be told from none
      within_layer = 0.25 * *passage;
      shortened = truncated_ = false;
      continue;
    }
    double from = 0.0, to = 1.0;
    std::size_t guard = 0;
    const bool event = negative_within(guards_start_, from, to, guard);
    if (event) end_at(locate(guard, from, to));
    if ((event && !ends_within_error()) || (tracks_ && !is_linearised())) {
      shortened = truncated_ = false;
      continue;
    }
    dt_ = std::min(shortened ? std::max(dt, dt_) : dt, within_layer);
    ++steps_;
    if (event) return land(guard, length);
    if (tried == due && step_.t1 == t_ + tried) return land_by_clock(length);
    break;
  }
  x_ = step_.x1;
  t_ = step_.t1;
  if (section_ && section_->before(x_)) armed_ = true;
  return Status::converged;
}

}  // namespace limcycle
