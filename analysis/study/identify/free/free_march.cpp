#include "limcycle/analysis/study/identify/free/free_march.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/illinois.hpp"
#include "limcycle/analysis/motion/steppers/radau_stages.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr int most_events = 200;  ///< between two stops

}  // namespace

FreeMarch::FreeMarch(const FreeMotion& motion, const Element& law, NumberSlopes* slopes, double fineness,
                     std::function<bool()> stop)
    : motion_(motion),
      A_(motion.rig.plant.A),
      B_u_(motion.rig.plant.B_u),
      B_F_(motion.rig.plant.B_F),
      C_v_(motion.rig.plant.C_v),
      v0_(motion.rig.plant.v0),
      law_(law),
      slopes_(slopes),
      own_slopes_(law),
      stop_(std::move(stop)),
      fineness_(fineness),
      mobility_(motion.rig.plant.C_v.dot(motion.rig.plant.B_F)),
      n_(plant_states + law.states()),
      scale_(n_) {
  if (const auto& gravity = motion.rig.plant.gravity) {
    B_gravity_ = motion.rig.plant.B_gravity;
    C_gravity_ = motion.rig.plant.C_gravity;
    torque_ = gravity->mass * gravity->gravity * gravity->arm;
  }
  z_.resize(static_cast<std::size_t>(law.states()));
  dz_.resize(z_.size());
  scale_.head<plant_states>() = motion.state_sizes;
  for (Index i = 0; i < law.states(); ++i) scale_(plant_states + i) = law.state_scale(static_cast<int>(i));
  for (auto* list : {&increments_, &rates_})
    for (auto& one : *list) one.setZero(n_);
  for (auto* one : {&x_, &rate_, &work_, &probe_, &error_}) one->setZero(n_);
}

void FreeMarch::take_input(std::size_t stop) {
  const auto& stops = motion_.stops;
  t_input_ = stops[stop].t;
  u_ = stops[stop].u;
  u_slope_ = 0.0;
  if (!motion_.holds_force && stop + 1 < stops.size())
    u_slope_ = (stops[stop + 1].u - u_) / (stops[stop + 1].t - t_input_);
}

/// The law's own guards, then that of a reversal.
void FreeMarch::guards(double t, const State& x) {
  rate(t, x, work_);
  guards_.resize(static_cast<std::size_t>(law_.guards(mode_)));
  law_.guard(in_, mode_, z_, guards_);
  // What a velocity of this size does is rounding, for the law too.
  const double least = (has_reversals() ? 1e-8 : 1e-12) * motion_.rubbing_speed;
  if (!has_reversals()) {
    if (law_.held(mode_) == Held::nothing) guards_.front() += least;
  } else {
    guards_.push_back(forward_ * in_.v + least);
  }
}

bool FreeMarch::begin(const FreeWindow& window, const Eigen::Vector2d& start) {
  t_ = motion_.stops[window.first].t;
  take_input(window.first);
  x_.setZero();
  x_.head<plant_states>() = start;
  deviations_.setZero(n_, columns());
  deviations_.topRightCorner(plant_states, plant_states).setIdentity();
  const double span = motion_.stops[window.last].t - t_;
  h_ = 1e-3 * span;
  steps_left_ = 100000 + 200 * static_cast<long>(window.last - window.first);
  mode_ = {};
  last_step_ = 0.0;
  begin_contact(window.sliding);
  rate(t_, x_, rate_);
  forward_ = in_.v < 0.0 ? -1.0 : 1.0;
  return x_.allFinite();
}

/// State of the contact at the start: that of long sliding, or a share of that of incipient sliding which balances the
/// body. In both the rate of each state vanishes, and depends on that state alone.
void FreeMarch::begin_contact(bool sliding) {
  rate(t_, x_, work_);
  const double drive = in_.drive, least = 1e-9 * motion_.rubbing_speed;
  if (z_.empty()) {
    mode_ = law_.start(in_, z_);
    return;
  }
  Input<double> in = in_;
  if (!sliding) in.v = drive < 0.0 ? -least : least;
  if (std::abs(in.v) < least) in.v = in.v < 0.0 ? -least : least;
  std::ranges::fill(z_, 0.0);
  mode_ = law_.knows_sliding() ? law_.after_sliding(in, z_) : law_.has_modes() ? law_.start(in, z_) : Mode{};
  const Index m = n_ - plant_states;
  ElementSlopes::Table by_state = own_slopes_.response(in, mode_, z_.data());
  for (int pass = 0; pass < 4; ++pass) {
    law_.rate(in, mode_, z_, dz_);
    for (Index i = 0; i < m; ++i)
      if (const double slope = by_state(1 + i, 2 + i); slope < 0.0)
        z_[static_cast<std::size_t>(i)] -= dz_[static_cast<std::size_t>(i)] / slope;
    by_state = own_slopes_.response(in, mode_, z_.data());
  }
  const double force = law_.output(in, mode_, z_);
  const double share = sliding ? 1.0 : std::abs(drive) < std::abs(force) ? drive / force : 0.0;
  if (share != 0.0) {
    const MatrixXd by_numbers = slopes_ != nullptr ? slopes_->response(in, mode_, z_) : MatrixXd(1 + m, 0);
    MatrixXd own = MatrixXd::Zero(m, columns());  // d(state of sliding)
    for (Index i = 0; i < m; ++i) {
      const double slope = by_state(1 + i, 2 + i);
      if (!(slope < 0.0)) continue;
      own.row(i).head(numbers()) = -by_numbers.row(1 + i) / slope;
      if (sliding) own.row(i).tail(plant_states) = -by_state(1 + i, 1) / slope * C_v_;
    }
    if (!sliding) {  // share = drive/force
      Eigen::RowVectorXd of_force = by_state.block(0, 2, 1, m) * own, of_drive = Eigen::RowVectorXd::Zero(columns());
      of_force.head(numbers()) += by_numbers.row(0);
      of_drive.tail(plant_states) = drive_row(x_.head<plant_states>());
      const Eigen::RowVectorXd of_share = (of_drive - share * of_force) / force;
      own *= share;
      for (Index i = 0; i < m; ++i) own.row(i) += z_[static_cast<std::size_t>(i)] * of_share;
    }
    deviations_.bottomRows(m) = own;
  }
  for (Index i = 0; i < m; ++i) x_(plant_states + i) = share * z_[static_cast<std::size_t>(i)];
  for (std::size_t i = 0; i < z_.size(); ++i) z_[i] = x_(plant_states + static_cast<Index>(i));
  if (!sliding && law_.has_modes()) mode_ = law_.start(in_, z_);
}

bool FreeMarch::accept(double h) {
  if (!carry(h)) return false;
  x_ += increments_[2];
  t_ += h;
  last_step_ = h;
  last_increments_ = increments_;
  return x_.allFinite();
}

/// Share of the step at which a guard that is negative after `share` of it breaks; by regula falsi (Illinois), each
/// time with a step of its own.
double FreeMarch::share_of_break(double h, double share, std::size_t guard, double at_end) {
  guards(t_, x_);
  const double at_start = guards_[guard];
  if (!(at_start > 0.0)) return 0.0;
  const auto value_at = [&](double part) -> std::optional<double> {
    if (!solve(h * part)) return std::nullopt;
    guards(t_ + h * part, probe_ = x_ + increments_[2]);
    return guards_[guard];
  };
  return falling_zero(value_at, 0.0, at_start, share, at_end, 1e-13 * (at_start - at_end));
}

/// The guard that breaks first within the solved step, looked for at its stages.
FreeMarch::Broken FreeMarch::first_broken(double h) {
  const auto& c = radau_stages().c;
  Broken first;
  for (std::size_t i = 0; i < stages; ++i) {
    guards(t_ + c[i] * h, probe_ = x_ + increments_[i]);
    guards_at_[i] = guards_;
  }
  for (std::size_t k = 0; k < guards_at_[0].size(); ++k)
    for (std::size_t i = 0; i < stages; ++i) {
      if (!(guards_at_[i][k] < 0.0)) continue;
      const double share = share_of_break(h, c[i], k, guards_at_[i][k]);
      if (first.guard < 0 || share < first.share) first = {static_cast<std::ptrdiff_t>(k), share};
      break;
    }
  return first;
}

/// The switch of a guard, and the deviations behind it.
void FreeMarch::fire(std::size_t guard) {
  last_step_ = 0.0;
  const auto own = static_cast<std::size_t>(law_.guards(mode_));
  if (guard == own) {  // a reversal: the rates go on without a jump
    forward_ = -forward_;
    return;
  }
  State before(n_), after(n_);
  rate(t_, x_, before);
  const ElementSlopes::Table row = own_slopes_.guard(in_, mode_, z_.data(), guard);
  const Eigen::RowVector2d by_plant = row(0, 1) * C_v_ + row(0, 2) * drive_row(x_.head<plant_states>());
  Eigen::RowVectorXd gradient(n_), shift = Eigen::RowVectorXd::Zero(columns());  // of the moment
  gradient << by_plant, row.block(0, 3, 1, n_ - plant_states);
  const double crossing = gradient.dot(before) + row(0, 2) * C_v_.dot(B_u_) / mobility_ * u_slope_;
  if (crossing < 0.0) {
    shift = -gradient * deviations_ / crossing;
    if (slopes_ != nullptr) shift.head(numbers()) -= slopes_->guard(in_, mode_, z_, guard).row(0) / crossing;
  }
  mode_ = law_.next(in_, mode_, z_, static_cast<int>(guard));
  for (std::size_t i = 0; i < z_.size(); ++i) x_(plant_states + static_cast<Index>(i)) = z_[i];
  if (law_.held(mode_) != Held::nothing) x_.head<plant_states>() -= B_F_ * (in_.v / mobility_);
  rate(t_, x_, after);
  deviations_ += (before - after) * shift;
}

bool FreeMarch::cross(double until) {
  events_ = 0;
  const double longest = (until - t_) / fineness_;
  while (t_ < until) {
    constexpr long steps_between = 512;
    if (--steps_left_ < 0 || (steps_left_ % steps_between == 0 && stop_ && stop_())) return false;
    const double left = until - t_;
    double h = std::min(h_, longest);
    if (h > left * (1.0 - 1e-9)) h = left;
    if (!(t_ + h > t_)) return false;
    if (!solve(h)) {
      h_ = 0.3 * h;
      continue;
    }
    const double error = error_of(h);
    const double factor = std::clamp(0.9 / std::pow(std::max(error, 1e-10), 0.25), 0.2, 5.0);
    if (!(error <= 1.0)) {
      h_ = h * std::min(factor, 0.8);
      continue;
    }
    const auto [guard, share] = first_broken(h);
    if (guard < 0) {
      h_ = h < h_ ? std::max(h_, factor * h) : factor * h;
      if (!accept(h)) return false;
      if (h == left) t_ = until;
      continue;
    }
    if (++events_ > most_events) return false;
    if (share > 0.0 && (!solve(h * share) || !accept(h * share))) return false;
    fire(static_cast<std::size_t>(guard));
  }
  return true;
}

bool FreeMarch::run(const FreeWindow& window, const Eigen::Vector2d& start, FreeRun& result) {
  const Eigen::RowVector2d y_row = motion_.rig.plant.C_y, rate_row = y_row * A_;
  result.samples.clear();
  result.y.clear();
  result.rate.clear();
  if (!begin(window, start)) return false;
  const auto most = static_cast<Index>(window.last - window.first + 1);
  result.y_slopes.resize(columns(), most);
  result.rate_slopes.resize(columns(), most);
  for (std::size_t i = window.first; i <= window.last; ++i) {
    if (i > window.first && !cross(motion_.stops[i].t)) return false;
    take_input(i);
    if (motion_.stops[i].sample < 0) continue;
    const Index k = std::ssize(result.samples);
    result.samples.push_back(motion_.stops[i].sample);
    result.y.push_back(y_row.dot(x_.head<plant_states>()));
    result.rate.push_back(rate_row.dot(x_.head<plant_states>()));
    const auto deviations = deviations_.topRows<plant_states>();
    result.y_slopes.col(k) = y_row(0) * deviations.row(0) + y_row(1) * deviations.row(1);
    result.rate_slopes.col(k) = rate_row(0) * deviations.row(0) + rate_row(1) * deviations.row(1);
  }
  return true;
}

}  // namespace limcycle
