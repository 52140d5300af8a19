#include <algorithm>
#include <cmath>
#include <limits>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/steppers/step_to_zero.hpp"

/// @file
/// Location of events within a step: switches of elements and crossings of the section.

namespace limcycle {
namespace {

constexpr std::size_t section_guard = std::numeric_limits<std::size_t>::max();

}  // namespace

double March::event_value(std::size_t guard, const State& x, double t) {
  if (guard == section_guard) return -section_->value(x);
  field_.guards(x, t, guards_mid_);
  return guards_mid_[guard];
}

/// True if a guard that is zero at the start of the step is negative at that fraction of it: by a whole step of the
/// method, since the interpolant of a body that slides off with ever growing force bends below zero, and would have it
/// stop, break away and stop again at the same instant.
bool March::leaves_at_once(std::size_t guard, double fraction) {
  const double h = fraction * (step_.t1 - step_.t0);
  repeat(h, work_);
  return event_value(guard, work_, step_.t0 + h) < 0.0;
}

/// Searches quarters of the step for the first guard that has turned negative, and brackets it by fractions of the
/// step.
bool March::negative_within(const std::vector<double>& at_start, double& from, double& to, std::size_t& guard) {
  const bool watch_section = section_ && (armed_ || section_->before(step_.x0));
  if (at_start.empty() && !(watch_section && section_->value(step_.x1) >= 0.0)) return false;
  for (int quarter = 1; quarter <= 4; ++quarter) {
    to = 0.25 * quarter;
    if (quarter == 4)
      work_ = step_.x1;
    else
      step_.interpolate(to, work_);
    if (!at_start.empty()) field_.guards(work_, step_.t0 + to * (step_.t1 - step_.t0), guards_end_);
    candidates_.clear();
    for (std::size_t k = 0; k < at_start.size(); ++k)
      if (guards_end_[k] < 0.0) candidates_.push_back(k);
    const bool crossed = watch_section && section_->value(work_) >= 0.0;
    if (quarter == 1)
      std::erase_if(candidates_, [&](std::size_t k) { return at_start[k] == 0.0 && !leaves_at_once(k, to); });
    if (crossed) candidates_.push_back(section_guard);
    if (!candidates_.empty()) {
      guard = first_of_candidates(at_start, from, to);
      return true;
    }
    from = to;
  }
  return false;
}

/// The guard on the interpolant, at a fraction of the step.
double March::value_between(std::size_t guard, double fraction) {
  step_.interpolate(fraction, work_);
  return event_value(guard, work_, step_.t0 + fraction * (step_.t1 - step_.t0));
}

/// Fraction of the step just after which the interpolant has the event, up to 1e-9 of the bracket.
double March::crossing(std::size_t guard, double from, double to) {
  for (int i = 0; i < 30; ++i) {
    const double mid = 0.5 * (from + to);
    (value_between(guard, mid) >= 0.0 ? from : to) = mid;
  }
  return to;
}

/// The event that comes first on the interpolant, of several in one bracket.
std::size_t March::first_of_candidates(const std::vector<double>& at_start, double from, double to) {
  if (candidates_.size() == 1) return candidates_.front();
  std::size_t first = candidates_.front();
  double earliest = infinite;
  for (const std::size_t k : candidates_) {
    const bool at_once = from == 0.0 && k != section_guard && at_start[k] <= 0.0;
    const double when = at_once ? 0.0 : crossing(k, from, to);
    if (when >= earliest) continue;
    earliest = when;
    first = k;
  }
  return first;
}

/// Length of the step at whose end the guard is zero; work_ is then the state there.
double March::locate(std::size_t guard, double from, double to) {
  const double h = step_.t1 - step_.t0;
  if (from == 0.0 && guard != section_guard && guards_start_[guard] <= 0.0) return 0.0;
  const auto between = [&](double length) { return value_between(guard, length / h); };
  const auto by_step = [&](double length) {
    repeat(length, work_);
    return event_value(guard, work_, step_.t0 + length);
  };
  const double rounding = 2e-16 * std::max(h, std::abs(step_.t0));
  const auto expected = on_interpolant(between, from * h, to * h);
  const double found = step_to_zero(by_step, from * h, to * h, expected, h, rounding);
  if (guard == section_guard || !field_.holds(field_.owner(guard))) return found;
  const double now = event_value(guard, work_, step_.t0 + found), last = to * h;
  return just_beyond(by_step, now, found, last, 2e-16 * std::max(last, std::abs(step_.t0)));
}

/// False if only the interpolant has the event that was located at the length `at` and sought up to the fraction `to`:
/// a motion that creeps towards a guard, slower than the tolerances resolve, does not reach it, but the cubic through
/// the ends of a long step may. The state at that length must be in work_, and is again.
bool March::happens(std::size_t guard, double at, double to) {
  constexpr double near_zero = 0.01;  // of the value at the start; a crossing that was located leaves a rounding
  if (guard == section_guard || at <= 4.0 * shortest_step()) return true;
  if (!(event_value(guard, work_, step_.t0 + at) > near_zero * guards_start_[guard])) return true;
  const double last = to * (step_.t1 - step_.t0);
  repeat(last, work_);
  const bool crossed = event_value(guard, work_, step_.t0 + last) < 0.0;
  repeat(at, work_);
  return crossed;
}

/// The guards of each element at the present state.
std::vector<std::vector<double>> March::guards_by_element() {
  std::vector<double> values;
  field_.guards(x_, t_, values);
  std::vector<std::vector<double>> all(field_.modes().size());
  for (std::size_t k = 0; k < values.size(); ++k) all[field_.owner(k)].push_back(values[k]);
  return all;
}

/// The guard of a switch that a jump has made necessary, if there is one: of a body that can no longer be held, or of
/// an element whose input jumped across where it switches, of guards that were positive `before`. Elements that have
/// switched since are left out of `before`.
std::optional<std::size_t> March::passed_by_jump(const std::vector<std::vector<double>>& before) {
  const auto now = guards_by_element();
  std::size_t k = 0;
  for (std::size_t i = 0; i < now.size(); ++i)
    for (std::size_t j = 0; j < now[i].size(); ++j, ++k)
      if (now[i][j] < 0.0 && (field_.holds(i) || (j < before[i].size() && before[i][j] > 0.0))) return k;
  return std::nullopt;
}

/// Lets follow at once the switches that the jump of the first one causes. For the derivative they happen on the
/// surface of the first one, whose time they have, and not on their own: that of a neighbour is passed by a jump, not
/// by its motion. False if there is no derivative.
bool March::release(SwitchSlopes& first, std::vector<std::vector<double>> before) {
  const std::size_t most = 2 * field_.modes().size();
  before[*step_.switched].clear();
  for (std::size_t count = 0; count < most; ++count) {
    const auto k = passed_by_jump(before);
    if (!k) return true;
    before[field_.owner(*k)].clear();
    SwitchSlopes next;
    field_.fire(x_, t_, *k, next);
    first.reset = next.reset * first.reset;
    first.after = next.after;
    first.saltation = first.reset + (first.after - first.reset * first.before) * first.guard / first.crossing;
    ++events_;
  }
  return false;
}

/// Ends the present step after the time h, with the state work_ there if h is not zero.
void March::end_at(double h) {
  step_.x1 = h > 0.0 ? work_ : step_.x0;
  step_.t1 = step_.t0 + h;
  field_.rate(step_.x1, step_.dx1, step_.t1);
}

/// See Step::crept.
bool March::creeps(std::size_t guard) const {
  constexpr double rounding = 1e-11;
  const std::size_t i = field_.owner(guard);
  const Loop& loop = field_.loop();
  const Element& element = loop.elements[i];
  if (!element.may_stick() || field_.holds(i)) return false;
  const Eigen::RowVectorXd& C_v = loop.ports[i].C_v;
  const double push = std::abs((C_v * loop.B.col(static_cast<Eigen::Index>(i))).value()) * element.scales().output;
  const double deceleration = (C_v * Eigen::Map<const Eigen::VectorXd>(step_.dx1.data(), loop.states())).value();
  return push > 0.0 && std::abs(deceleration) <= rounding * push;
}

/// Completes a step that ends at an event, of one that was tried for the time `tried`.
Status March::land(std::size_t guard, double tried) {
  const bool at_once = step_.t1 == step_.t0;
  if (!is_finite(step_.x1) || !is_finite(step_.dx1)) return Status::not_finite;
  x_ = step_.x1;
  t_ = step_.t1;
  fresh_ = true;
  if (guard == section_guard) {
    step_.on_section = true;
    armed_ = false;
    return Status::converged;
  }
  step_.crept = creeps(guard);
  step_.switched = field_.owner(guard);
  // A body that is at once at rest again was carried there by such a long step that its velocity is within the
  // tolerance.
  if (at_once && field_.loop().elements[*step_.switched].may_stick() && !field_.holds(*step_.switched))
    dt_ = 0.125 * tried;
  if (tracks_) {
    SwitchSlopes slopes;
    auto before = guards_by_element();
    if (field_.fire(x_, t_, guard, slopes) && release(slopes, std::move(before)))
      step_.transition = slopes.saltation * step_.transition;
    else
      step_.transition.resize(0, 0);
  } else {
    field_.fire(x_, t_, guard);
  }
  ++events_;
  if (step_.by_clock) return Status::converged;
  event_times_.push_back(t_);
  if (event_times_.size() > 50) event_times_.pop_front();
  // In seconds, not relative to the motion: the slowest pole may be far slower, the fastest far faster, than any swing.
  const double short_time = 1e-10 * std::max(1.0, std::abs(t_));
  const bool accumulate = event_times_.size() == 50 && t_ - event_times_.front() < short_time;
  return accumulate ? Status::chattering : Status::converged;
}

/// The step to the next switch of a clock while nothing else moves, or over many of them: a body that waits for an
/// integrator may do so for millions of samples.
Status March::wait_for_clock(double due, double t_end) {
  if (wait_ && !tracks_ && !field_.driven())
    if (auto leap = wait_->look(field_, x_, t_, guards_start_, t_end)) {
      step_.x1 = x_ = std::move(leap->x);
      step_.t1 = t_ = leap->t;
      step_.dx1 = step_.dx0;
      step_.by_clock = fresh_ = true;
      ++steps_;
      return Status::converged;
    }
  step_.x1 = step_.x0;
  for (std::size_t i = 0; i < x_.size(); ++i) step_.x1[i] += due * step_.dx0[i];
  step_.t1 = t_ + due;
  step_.dx1 = step_.dx0;
  ++steps_;
  if (tracks_) step_.transition = Eigen::MatrixXd::Identity(std::ssize(x_), std::ssize(x_));
  return land_by_clock(due);
}

/// Completes a step of the length `tried`, at whose end the clock of an element has run down.
Status March::land_by_clock(double tried) {
  if (tried == 0.0) {
    end_at(0.0);
    ++steps_;
    if (tracks_) step_.transition = Eigen::MatrixXd::Identity(std::ssize(x_), std::ssize(x_));
  }
  field_.guards(step_.x1, step_.t1, guards_mid_);
  step_.by_clock = true;
  return land(field_.clock_guard(guards_mid_), tried);
}

}  // namespace limcycle
