#include "limcycle/analysis/orbit/branch/branch_map.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t loops_kept = 6;  // a corrector step and its differences use three
constexpr double much_longer = 100.0;  // than its neighbour a return does not last, but one that never comes

std::size_t states_of(const Loop& loop) {
  auto count = static_cast<std::size_t>(loop.states());
  for (const auto& element : loop.elements) count += static_cast<std::size_t>(element.states());
  return count;
}

}  // namespace

ParameterScale::ParameterScale(double from, double to) : from_(from), to_(to) {
  if (!std::isfinite(from) || !std::isfinite(to) || from == to)
    throw std::invalid_argument("the ends of a parameter's range must be finite and differ, got " +
                                std::to_string(from) + " and " + std::to_string(to));
  const double ratio = from * to > 0.0 ? to / from : 1.0;
  logarithmic_ = ratio > 3.0 || ratio < 1.0 / 3.0;
}

double ParameterScale::s(double p) const {
  return length * (logarithmic_ ? std::log(p / from_) / std::log(to_ / from_) : (p - from_) / (to_ - from_));
}

double ParameterScale::p(double s) const {
  if (s == 0.0) return from_;
  if (s == length) return to_;
  return logarithmic_ ? from_ * std::pow(to_ / from_, s / length) : from_ + s / length * (to_ - from_);
}

double ParameterScale::slope(double s) const {
  return (logarithmic_ ? p(s) * std::log(to_ / from_) : to_ - from_) / length;
}

BranchMap::Prepared& BranchMap::prepared(double s) {
  const auto known = std::ranges::find(recent_, s, &Prepared::s);
  if (known != recent_.end()) return *known;
  if (recent_.size() == loops_kept) recent_.erase(recent_.begin());
  auto made = family_(scale_.p(s));
  recent_.push_back({s, made ? std::make_shared<const Loop>(std::move(*made)) : nullptr, nullptr});
  return recent_.back();
}

std::shared_ptr<const Loop> BranchMap::loop(double s) { return prepared(s).loop; }

void BranchMap::set_frame(Frame frame) {
  frame_ = std::move(frame);
  for (auto& loop : recent_) loop.map.reset();
}

BranchMap::Value BranchMap::at(const VectorXd& u, double s, With with, double rtol) {
  Value value;
  Prepared& here = prepared(s);
  if (here.loop && !here.map) {
    auto half = frame_.half ? symmetry(*here.loop) : std::nullopt;
    const bool fits = static_cast<std::size_t>(frame_.chart.scale.size()) == frame_.origin.x.size() &&
                      (!frame_.half || half) && states_of(*here.loop) == frame_.origin.x.size();
    const ReturnMap::Options options{rtol, steps_a_map, stop_};
    if (fits) here.map = std::make_unique<ReturnMap>(*here.loop, frame_.section, std::move(half), options);
  }
  if (!here.map) {
    value.valid = false;
    value.status = Status::not_finite;
    return value;
  }
  here.map->set_rtol(rtol);
  here.map->set_derivative(with == With::derivatives);
  here.map->set_extremes(with != With::nothing);
  here.map->set_trace(with == With::trace);
  here.map->set_longest(longest_return_);
  value.start = {frame_.chart.lift(frame_.origin.x, u), frame_.origin.modes};
  const long before = here.map->steps();
  value.motion = (*here.map)(value.start);
  steps_ += here.map->steps() - before;
  ++maps_;
  value.status = value.motion.status;
  if (value.status != Status::converged) return value;
  longest_return_ = much_longer * value.motion.time;
  value.r = frame_.chart.coordinates(value.motion.state.x, value.start.x);
  value.time = value.motion.time;
  if (with == With::nothing) return value;
  value.amplitude = here.map->amplitude(value.motion);
  if (with == With::derivatives) differentiate(*here.map, value);
  return value;
}

void BranchMap::differentiate(const ReturnMap& map, Value& value) const {
  const auto& motion = value.motion;
  if (motion.derivative.size() == 0) {
    value.status = Status::stalled;  // a switch is touched, not crossed: no derivative exists
    return;
  }
  const auto& chart = frame_.chart;
  const MatrixXd lift = chart.scale.asDiagonal() * chart.basis;
  value.D = chart.restricted(motion.derivative);
  value.time_slope = motion.time_gradient * lift;
  value.amplitude_slope = map.amplitude_gradient(motion) * lift;
  if (!value.D.allFinite() || !value.time_slope.allFinite() || !value.amplitude_slope.allFinite())
    value.status = Status::not_finite;
}

std::optional<VectorXd> BranchMap::slope(const VectorXd& u, double s, double step, const VectorXd& here, double rtol) {
  const Value plus = at(u, s + step, With::nothing, rtol), minus = at(u, s - step, With::nothing, rtol);
  bool ahead = plus.status == Status::converged, behind = minus.status == Status::converged;
  if (ahead && behind) {
    const double forward = (plus.r - here).norm(), backward = (minus.r - here).norm();
    const double noise = std::max(1e-6, 100.0 * rtol);
    if (forward < 20.0 * backward + noise && backward < 20.0 * forward + noise)
      return (plus.r - minus.r) / (2.0 * step);
    ahead = forward < backward;
    behind = !ahead;
  }
  if (!ahead && !behind) return std::nullopt;
  const double side = ahead ? step : -step;
  const Value near = at(u, s + 0.5 * side, With::nothing, rtol), middle = at(u, s, With::nothing, rtol);
  if (near.status != Status::converged || middle.status != Status::converged) return std::nullopt;
  const VectorXd& far = ahead ? plus.r : minus.r;
  return (4.0 * near.r - far - 3.0 * middle.r) / side;  // one-sided, also of second order
}

}  // namespace limcycle
