#include "limcycle/analysis/energy/one_state/one_state_law.hpp"
#include "limcycle/analysis/golden_maximum.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace limcycle {
namespace {

constexpr double slowest_creep =
    1e-60;  // velocity scales: the limit v -> 0+, where even exp(-|v/vs|^0.2) is 1 to the last bit
constexpr double unbounded = 1048576.0;  // state scales beyond which a state counts as unbounded

}  // namespace

bool OneStateLaw::fits(const Element& element) { return element.facts().is_one_state; }

OneStateLaw::OneStateLaw(const Element& law, double top_speed)
    : law_(law),
      top_speed_(top_speed),
      velocity_scale_(law.scales().velocity),
      rate_independent_(!std::isfinite(law.scales().velocity)) {
  if (!fits(law)) throw std::invalid_argument("the law is not one of one state and f(z, v)");
  if (!(top_speed > 0.0)) throw std::invalid_argument("a top speed must be positive, not " + std::to_string(top_speed));
  // Any speed suits a rate-independent law: one at which it passes through its range in a tenth of a second.
  if (rate_independent_) velocity_scale_ = std::min(top_speed, 10.0 * law.scales().displacement);
  choose_speeds();
  add_extreme_speeds();
  low_ = edge(-1);
  high_ = edge(1);
}

OneStatePoint OneStateLaw::at(double z, double v) const {
  const Input<double> in{0.0, v, std::copysign(infinite, v)};
  double state[1] = {z}, dz[1] = {0.0}, guards[8] = {};
  OneStatePoint point;
  if (law_.has_modes()) {
    point.mode = law_.start(in, state);
    for (int k = 0; k < 8; ++k) {
      const int count = law_.guards(point.mode);
      law_.guard(in, point.mode, state, std::span<double>(guards, static_cast<std::size_t>(count)));
      const double* negative = std::find_if(guards, guards + count, [](double g) { return g < 0.0; });
      if (negative == guards + count) break;
      point.mode = law_.next(in, point.mode, state, static_cast<int>(negative - guards));
    }
    point.exists = std::abs(state[0] - z) <= 1e-12 * law_.state_scale(0);
  }
  law_.rate(in, point.mode, state, dz);
  point.rate = dz[0];
  point.force = law_.output(in, point.mode, state);
  point.supply = point.force * v;
  return point;
}

double OneStateLaw::gain(double z, double v, int direction) const {
  const OneStatePoint point = at(z, v);
  if (!point.exists || !(point.rate * direction > 0.0)) return -infinite;
  return -point.supply / std::abs(point.rate);
}

void OneStateLaw::choose_speeds() {
  if (rate_independent_) {
    speeds_ = {velocity_scale_};
    return;
  }
  speeds_ = {slowest_creep * velocity_scale_};
  const auto add = [this](double from, double to, int a_decade) {
    const int count = static_cast<int>(std::lround(a_decade * std::log10(to / from)));
    for (int k = 0; k <= count; ++k) speeds_.push_back(velocity_scale_ * from * std::pow(to / from, 1.0 * k / count));
  };
  add(1e-9, 1e-2, 8);
  add(1e-2, 1e2, 40);
  add(1e2, 1e9, 8);
  const auto knots = law_.knots();
  for (std::size_t i = 1; i < knots.size(); ++i)
    for (int k = 1; k <= 8; ++k) speeds_.push_back(knots[i - 1] + k / 8.0 * (knots[i] - knots[i - 1]));
  if (std::isfinite(top_speed_)) {
    std::erase_if(speeds_, [this](double v) { return v >= top_speed_; });
    speeds_.push_back(top_speed_);
  }
  std::ranges::sort(speeds_);
  speeds_.erase(std::unique(speeds_.begin(), speeds_.end()), speeds_.end());
}

/// Extrema of f/|v| at a few states in both directions: near the end of the states only speeds close to these still
/// drive z outwards.
void OneStateLaw::add_extreme_speeds() {
  std::vector<double> found;
  for (const double state : {-1.0, -0.5, 0.5, 1.0})
    for (const int side : {-1, 1})
      for (const double sense : {-1.0, 1.0}) {
        const auto pull = [&](double log_speed) {
          const double v = side * std::exp(log_speed);
          return sense * at(state * law_.state_scale(0), v).rate / std::abs(v);
        };
        for (std::size_t i = 1; i + 1 < speeds_.size(); ++i) {
          const double a = std::log(speeds_[i - 1]), b = std::log(speeds_[i]), c = std::log(speeds_[i + 1]);
          const double here = pull(b);
          const double most = std::max(pull(a), pull(c));
          if (here > most + 1e-12 * std::abs(most)) found.push_back(std::exp(golden_maximum(pull, a, b, c, 40)));
        }
      }
  speeds_.insert(speeds_.end(), found.begin(), found.end());
  std::ranges::sort(speeds_);
  speeds_.erase(std::unique(speeds_.begin(), speeds_.end()), speeds_.end());
}

std::vector<double> OneStateLaw::outward(double z, int direction) const {
  std::vector<double> found;
  for (const double speed : speeds_)
    for (const double v : {speed, -speed}) {
      const OneStatePoint point = at(z, v);
      if (point.exists && point.rate * direction > 0.0) found.push_back(v);
    }
  return found;
}

bool OneStateLaw::goes(double z, int direction, const std::vector<double>& velocities) const {
  return std::ranges::any_of(velocities, [&](double v) {
    const OneStatePoint point = at(z, v);
    return point.exists && point.rate * direction > 0.0;
  });
}

/// The last place at which the velocities drive z on, between a place where one does and one where none does, or the
/// reverse.
double OneStateLaw::last_place(double here, double there, int direction, const std::vector<double>& velocities) const {
  double middle = 0.5 * (here + there);
  while (middle != here && middle != there) {
    (goes(middle, direction, velocities) ? here : there) = middle;
    middle = 0.5 * (here + there);
  }
  return here;
}

/// Marches outwards. If no velocity drives z through both of two places, a wall between them may stop all: there is one
/// if the velocities of the nearer place cease to drive z before those of the farther one begin.
double OneStateLaw::edge(int direction) const {
  const double scale = direction * law_.state_scale(0);
  double reached = 0.0;
  std::vector<double> near = outward(0.0, direction);
  if (near.empty()) return 0.0;
  double next = 0.0;
  while (next <= unbounded) {
    next = next < 4.0 ? next + 1.0 / 64.0 : 2.0 * next;
    const double place = next * scale;
    std::vector<double> far = outward(place, direction);
    if (!goes(place, direction, near)) {
      const double end = last_place(reached, place, direction, near);
      if (far.empty() || std::abs(last_place(place, reached, direction, far)) > std::abs(end)) return end;
    }
    near = std::move(far);
    reached = place;
  }
  return direction * infinite;
}

}  // namespace limcycle
