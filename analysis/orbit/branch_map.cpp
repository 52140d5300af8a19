#include "limcycle/analysis/orbit/branch_map.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>
#include <string>

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr long steps_a_map = 200000;
constexpr std::size_t loops_kept = 6;  // a corrector step and its differences use three

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

std::shared_ptr<const Loop> BranchMap::loop(double s) {
  for (const auto& [at, loop] : recent_)
    if (at == s) return loop;
  const auto made = family_(scale_.p(s));
  auto loop = made ? std::make_shared<const Loop>(*made) : nullptr;
  if (recent_.size() == loops_kept) recent_.erase(recent_.begin());
  recent_.emplace_back(s, loop);
  return loop;
}

BranchMap::Value BranchMap::at(const VectorXd& u, double s, bool with_derivative, double rtol) {
  Value value;
  const auto loop = this->loop(s);
  const auto half = loop && frame_.half ? symmetry(*loop) : std::nullopt;
  const bool fits = loop && static_cast<std::size_t>(frame_.chart.scale.size()) == frame_.origin.x.size() &&
                    (!frame_.half || half) && LoopField(*loop).size() == frame_.origin.x.size();
  if (!fits) {
    value.valid = false;
    value.status = Status::not_finite;
    return value;
  }
  ReturnMap map(*loop, frame_.section, half, {rtol, steps_a_map, stop_, with_derivative});
  value.start = {frame_.chart.lift(frame_.origin.x, u), frame_.origin.modes};
  const auto result = map(value.start);
  ++maps_;
  value.status = result.status;
  if (result.status != Status::converged) return value;
  value.time = result.time;
  value.largest = result.largest;
  value.r = frame_.chart.coordinates(result.state.x, value.start.x);
  if (!with_derivative) return value;
  if (result.derivative.size() == 0) {
    value.status = Status::stalled;  // a switch is touched, not crossed: there is no derivative
    return value;
  }
  value.D = frame_.chart.restricted(result.derivative);
  return value;
}

std::optional<VectorXd> BranchMap::slope(const VectorXd& u, double s, double step, const VectorXd& here) {
  const Value plus = at(u, s + step, false), minus = at(u, s - step, false);
  bool ahead = plus.status == Status::converged, behind = minus.status == Status::converged;
  if (ahead && behind) {
    const double forward = (plus.r - here).norm(), backward = (minus.r - here).norm();
    constexpr double noise = 1e-6;
    if (forward < 20.0 * backward + noise && backward < 20.0 * forward + noise)
      return (plus.r - minus.r) / (2.0 * step);
    ahead = forward < backward;
    behind = !ahead;
  }
  if (!ahead && !behind) return std::nullopt;
  const double side = ahead ? step : -step;
  const Value near = at(u, s + 0.5 * side, false), middle = at(u, s, false);
  if (near.status != Status::converged || middle.status != Status::converged) return std::nullopt;
  const VectorXd& far = ahead ? plus.r : minus.r;
  return (4.0 * near.r - far - 3.0 * middle.r) / side;  // one-sided, of second order too
}

}  // namespace limcycle
