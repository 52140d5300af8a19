#include "limcycle/analysis/orbit/settle/watch/rest_watch.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/typical_sizes.hpp"

namespace limcycle {

RestWatch::Verdict RestWatch::look(double t, const State& x, const State& dx) {
  if (t < next_) return Verdict::moving;
  next_ = t + std::max(0.5 * (t - since_), slow_);
  steady_ = rates_constant(dx) ? steady_ + 1 : 0;
  calm_ = rates_fade(t, dx) ? calm_ + 1 : 0;
  still_ = stays(t, x) ? still_ + 1 : 0;
  return calm_ >= 3 || still_ >= 3 ? Verdict::at_rest : steady_ >= 4 ? Verdict::steady : Verdict::moving;
}

bool RestWatch::rates_constant(const State& dx) {
  double change = 0.0;
  for (std::size_t i = 0; i < rates_before_.size(); ++i)
    change = std::max(change, std::abs(dx[i] - rates_before_[i]) * slow_ / sizes_[i]);
  const bool constant = !rates_before_.empty() && change <= 1e-7;
  rates_before_ = dx;
  return constant;
}

double RestWatch::rate(const State& dx) const {
  double largest = 0.0;
  for (std::size_t i = 0; i < dx.size(); ++i) largest = std::max(largest, std::abs(dx[i]) * slow_ / sizes_[i]);
  return largest;
}

bool RestWatch::rates_fade(double t, const State& dx) {
  const double largest = rate(dx), drift = largest * (t + slow_) / slow_;
  const bool fades = largest <= noise() || (drift < 0.6 * last_ && drift < 1e-6);
  last_ = drift;
  return fades;
}

bool RestWatch::stays(double t, const State& x) {
  double rate = before_.empty() ? infinite : 0.0;
  for (std::size_t i = 0; i < before_.size(); ++i)
    rate = std::max(rate, std::abs(x[i] - before_[i]) / (t - looked_) * slow_ / sizes_[i]);
  before_ = x;
  looked_ = t;
  return rate <= noise();
}

double rubbing_speed(const Loop& loop) {
  if (!loop.ports.back().rubs) return infinite;
  const Scales scales = loop.elements.back().scales();
  constexpr double rounding = 1e-8;  // relative to the velocities of the moving body
  return std::isfinite(scales.velocity) ? scales.velocity / 100.0 : rounding * typical_rubbing_velocity(loop);
}

bool slides_at_rest(const Loop& loop) {
  const Port& port = loop.ports.back();
  bool exact = false;
  const Eigen::VectorXd rest = loop.rest_point(exact);
  return std::abs((port.C_v * rest + port.c_v * loop.external).value()) > rubbing_speed(loop);
}

bool died_out(const TurningPoints& turning, double rest, double floor) {
  const auto& points = turning.points();
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(turning.swing(k) < turning.swing(k + 1))) return false;
    const auto& point = points[points.size() - 1 - k];
    const auto& before = points[points.size() - 2 - k];
    if (turning.swing(k) > floor || std::abs(point.y - rest) > floor || point.t < 1.3 * before.t) return false;
  }
  return true;
}

}  // namespace limcycle
