#include "limcycle/analysis/motion/march.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "limcycle/analysis/motion/march_stepper.hpp"
#include "limcycle/analysis/motion/steppers/transition.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"

namespace limcycle {
namespace {

constexpr double longest_step = 1e15;  ///< relative to that of the motion
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

void Step::interpolate(double theta, State& x) const {
  const double h = t1 - t0, left = 1.0 - theta;
  x.resize(x0.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double chord = x1[i] - x0[i];
    x[i] = left * x0[i] + theta * x1[i] -
           theta * left * ((1.0 - 2.0 * theta) * chord + h * (theta * dx1[i] - left * dx0[i]));
  }
}

March::~March() = default;
March::March(March&&) noexcept = default;

March::March(LoopField& field, StepperKind kind, ErrorWeights weights)
    : field_(field),
      kind_(kind == StepperKind::automatic ? choose_stepper(field.loop(), weights.rtol, field.driven()) : kind),
      stepper_(std::make_unique<Stepper>(kind_, weights, field)),
      weights_(std::move(weights)) {
  if (kind_ == StepperKind::exact && (field.driven() || !AffineFlow::applies(field.loop())))
    throw std::invalid_argument("simulate.stepper exact is for loops of piecewise affine elements without signals");
  constexpr double widths = 8.0;  // beyond, a Stribeck curve is flat or changes slowly
  const Loop& loop = field.loop();
  steep_ = has_infinite_slope(loop);
  if (kind == StepperKind::automatic) wait_patiently();
  if (loop.continuous) wait_.emplace(loop);
  for (std::size_t i = 0; i < loop.elements.size() && kind_ != StepperKind::exact; ++i)
    if (const double width = loop.elements[i].scales().velocity; loop.ports[i].rubs && std::isfinite(width))
      layers_.push_back({i, widths * width});
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
  if (wait_) wait_->interrupt();
}

void March::reset() {
  dt_ = 0.0;
  steps_ = events_ = 0;
  if (stepper_->clocked) stepper_->clocked->reset();
}

/// Derivative of the end of the present step over its start, before any switch.
Eigen::MatrixXd March::smooth_transition() {
  const auto n = static_cast<Eigen::Index>(x_.size());
  if (step_.t1 == step_.t0) return Eigen::MatrixXd::Identity(n, n);
  if (kind_ == StepperKind::exact) return std::get<ExactStepper>(stepper_->moving).exponential().topLeftCorner(n, n);
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
    stepper_->restart();
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
    return wait_for_clock(due, t_end);
  if (wait_) wait_->interrupt();
  double dt = std::min({dt_, dt_max_, t_end - t_, due});
  bool shortened = dt < dt_;  // by the requested end, not by the error: the next step may be as long as before
  truncated_ = dt == t_end - t_ || dt == due;
  if (auto& clocked = stepper_->clocked) clocked->in_use = dt == due && !stepper_->waits && clocked->is_due();
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
    const double at = event ? locate(guard, from, to) : 0.0;
    const bool mistaken = event && !happens(guard, at, to);
    if (event) end_at(at);
    if (mistaken || (event && !ends_within_error()) || (tracks_ && !is_linearised())) {
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
