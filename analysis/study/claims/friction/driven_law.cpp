#include "limcycle/analysis/study/claims/friction/driven_law.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace limcycle {

DrivenLaw::DrivenLaw(Element law, double velocity)
    : law_(std::move(law)), z_(static_cast<std::size_t>(law_.states())), direction_(velocity < 0.0 ? -1.0 : 1.0) {
  now_ = at(0.0, velocity);
  mode_ = law_.start(now_, z_);
}

/// The body cannot be held; the sign of the drive is that of the motion.
Input<double> DrivenLaw::at(double x, double v) const { return {x, v, direction_ * infinite}; }

/// End of a step from the present state.
void DrivenLaw::move(const Velocity& velocity, double t, double h, Moved& end) {
  constexpr std::array part{0.0, 0.5, 0.5, 1.0}, weight{1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
  end.z = stage_ = z_;
  end.x = x_;
  end.work = work_;
  double v = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double x = k == 0 ? x_ : x_ + part[k] * h * v;
    v = velocity(t + part[k] * h);
    slope_[k].resize(z_.size());
    if (k > 0)
      for (std::size_t i = 0; i < z_.size(); ++i) stage_[i] = z_[i] + part[k] * h * slope_[k - 1][i];
    const Input<double> in = at(x, v);
    law_.rate(in, mode_, stage_, slope_[k]);
    for (std::size_t i = 0; i < z_.size(); ++i) end.z[i] += h * weight[k] * slope_[k][i];
    end.x += h * weight[k] * v;
    end.work += h * weight[k] * law_.output(in, mode_, stage_) * v;
  }
}

int DrivenLaw::broken_guard(const Input<double>& in, std::span<const double> z) {
  if (!law_.has_modes()) return -1;
  guards_.resize(static_cast<std::size_t>(law_.guards(mode_)));
  law_.guard(in, mode_, z, guards_);
  int broken = -1;
  for (std::size_t k = 0; k < guards_.size(); ++k)
    if (guards_[k] < 0.0 && (broken < 0 || guards_[k] < guards_[static_cast<std::size_t>(broken)]))
      broken = static_cast<int>(k);
  return broken;
}

/// Switches until the mode fits the motion.
void DrivenLaw::settle(const Input<double>& in) {
  for (int k = 0; k < 1000; ++k) {
    const int broken = broken_guard(in, z_);
    if (broken < 0) return;
    mode_ = law_.next(in, mode_, z_, broken);
  }
  throw std::domain_error("a law under prescribed motion does not stop switching");
}

void DrivenLaw::step(const Velocity& velocity, double t, double h) {
  const double end = t + h;
  for (int switches = 0; t < end; ++switches) {
    if (switches == 1000) throw std::domain_error("a law under prescribed motion switches without end");
    move(velocity, t, end - t, next_);
    double to = end;
    if (broken_guard(at(next_.x, velocity(end)), next_.z) >= 0) {
      double before = t;
      while (true) {
        const double middle = 0.5 * (before + to);
        if (!(middle > before && middle < to)) break;
        move(velocity, t, middle - t, tried_);
        (broken_guard(at(tried_.x, velocity(middle)), tried_.z) >= 0 ? to : before) = middle;
      }
      move(velocity, t, to - t, next_);
    }
    z_ = next_.z;
    x_ = next_.x;
    work_ = next_.work;
    now_ = at(x_, velocity(to));
    settle(now_);
    t = to;
  }
  for (const double z : z_)
    if (!std::isfinite(z)) throw std::domain_error("a law under prescribed motion has lost its state");
}

void DrivenLaw::go(const Velocity& velocity, double duration, int steps) {
  const double h = duration / steps;
  const double first = velocity(0.5 * h);
  direction_ = first < 0.0 ? -1.0 : 1.0;
  now_ = at(x_, velocity(0.0));
  settle(now_);
  for (int k = 0; k < steps; ++k) {
    const double t = h * k;
    step(velocity, t, h);
    if (watch) watch(t + h);
  }
}

void DrivenLaw::slide(double velocity, double distance, int steps) {
  go([velocity](double) { return velocity; }, distance / std::abs(velocity), steps);
}

bool DrivenLaw::slide_to_force(double velocity, double force, double step, int most) {
  const double side = velocity < 0.0 ? -1.0 : 1.0;
  for (int k = 0; k < most; ++k) {
    const DrivenLaw before = *this;
    slide(velocity, step, 1);
    if (side * (this->force() - force) < 0.0) continue;
    double low = 0.0, high = step;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      *this = before;
      if (middle > 0.0) slide(velocity, middle, 1);
      (side * (this->force() - force) < 0.0 ? low : high) = middle;
    }
    return true;
  }
  return false;
}

}  // namespace limcycle
