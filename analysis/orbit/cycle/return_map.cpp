#include "limcycle/analysis/orbit/cycle/return_map.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"

namespace limcycle {

LoopState Reflection::of(const Loop& loop, const LoopState& state) const {
  LoopState mirrored = state;
  const Eigen::VectorXd sign = signs(loop);
  for (std::size_t i = 0; i < mirrored.x.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    mirrored.x[i] = (k < centre.size() ? 2.0 * centre(k) : 0.0) + sign(k) * state.x[i];
  }
  for (std::size_t i = 0; i < mirrored.modes.size(); ++i) mirrored.modes[i] = loop.elements[i].mirror(state.modes[i]);
  return mirrored;
}

Eigen::VectorXd Reflection::signs(const Loop& loop) {
  std::vector<double> sign(static_cast<std::size_t>(loop.states()), -1.0);
  for (const auto& element : loop.elements)
    for (int i = 0; i < element.states(); ++i) sign.push_back(element.even_state(i) ? 1.0 : -1.0);
  return Eigen::Map<const Eigen::VectorXd>(sign.data(), std::ssize(sign));
}

std::optional<Reflection> symmetry(const Loop& loop) {
  for (const auto& element : loop.elements)
    if (!element.odd()) return std::nullopt;
  bool exact = false;
  const Eigen::VectorXd rest = loop.rest_point(exact);
  if (!exact) return std::nullopt;
  const State sizes = typical_sizes(loop);
  const Eigen::VectorXd typical =
      Eigen::Map<const Eigen::VectorXd>(sizes.data(), loop.states()).cwiseMax(rest.cwiseAbs());
  const auto vanishes = [&](const Eigen::RowVectorXd& C, const Eigen::RowVector4d& c) {
    const double size = (C.cwiseAbs() * typical + c.cwiseAbs() * loop.external.cwiseAbs()).value();
    return std::abs((C * rest + c * loop.external).value()) <= 1e-11 * size;
  };
  for (const Port& port : loop.ports) {
    if (!vanishes(port.C_v, port.c_v) || (!port.rubs && !vanishes(port.C, port.c))) return std::nullopt;
  }
  return Reflection{rest};
}

ReturnMap::ReturnMap(const Loop& loop, Section section, std::optional<Reflection> half, Options options)
    : loop_(&loop),
      typical_(typical_sizes(loop)),
      weights_(loop_weights(loop, options.rtol, typical_)),
      kind_(choose_stepper(loop, options.rtol)),
      field_(std::make_unique<LoopField>(loop)),
      section_(std::move(section)),
      half_(std::move(half)),
      options_(std::move(options)) {}

/// A march with the present options; kept, since its preparation costs as much as a short map.
March& ReturnMap::march() {
  StepperKind kind = kind_;
  if (kind != StepperKind::exact && kind != StepperKind::rodas5p) {
    // The variational equations follow the interpolated step: that of a method of low order, whose steps are short.
    kind = options_.derivative ? StepperKind::rodas5p : explicit_stepper(options_.rtol);
  }
  if (!march_ || march_->kind() != kind || march_rtol_ != options_.rtol) {
    march_.reset();
    march_.emplace(*field_, kind, weights_.scaled_to(options_.rtol));
    march_->wait_patiently();
    march_rtol_ = options_.rtol;
  }
  march_->reset();
  march_->track(options_.derivative);
  return *march_;
}

/// A step far longer than any time constant, in which nothing moves: no return will follow.
bool ReturnMap::rests(const Step& last) const {
  constexpr double long_times = 1e6, rounding = 1e-12;
  if (last.t1 - last.t0 < long_times * weights_.time) return false;
  for (std::size_t i = 0; i < last.x1.size(); ++i)
    if (std::abs(last.x1[i] - last.x0[i]) > rounding * std::max(std::abs(last.x1[i]), typical_[i])) return false;
  return true;
}

ReturnMap::Result ReturnMap::run(const LoopState& from, const Section& target) {
  Result result;
  field_->modes() = from.modes;
  March& march = this->march();
  march.begin(from.x, 0.0, target);
  carried_ = Eigen::MatrixXd::Identity(std::ssize(from.x), std::ssize(from.x));
  result.largest.assign(from.x.size(), 0.0);
  if (options_.trace) append(result.trace, *field_, march);
  double first_switch = infinite, last_switch = -infinite;
  do {
    if (options_.stop && options_.stop()) result.status = Status::interrupted;
    if (march.steps() > options_.max_steps || march.t() >= options_.longest) result.status = Status::max_iterations;
    if (result.status == Status::converged) result.status = march.step(options_.longest);
    if (result.status == Status::converged && (march.last().crept || rests(march.last())))
      result.status = Status::no_cycle;
    if (result.status != Status::converged) break;
    if (options_.extremes) result.extremes.include(*field_, march, static_cast<std::size_t>(march.steps() - 1));
    if (options_.trace) append(result.trace, *field_, march);
    if (march.last().switched) {
      first_switch = std::min(first_switch, march.t());
      last_switch = march.t();
    }
    for (std::size_t i = 0; i < result.largest.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const double centre = half_ && k < half_->centre.size() ? half_->centre(k) : 0.0;
      result.largest[i] = std::max(result.largest[i], std::abs(march.x()[i] - centre));
    }
    if (options_.derivative && !result.time_shift) carry(result, march);
  } while (!march.last().on_section);
  steps_ += march.steps();
  result.state = {march.x(), field_->modes()};
  result.time = march.t();
  result.switch_distance = std::min(first_switch, result.time - last_switch) / result.time;
  if (options_.derivative && result.status == Status::converged) close_derivative(result, from, target);
  return result;
}

Eigen::VectorXd ReturnMap::sizes(const Result& result) const {
  const auto n = std::ssize(typical_);
  return Eigen::Map<const Eigen::VectorXd>(result.largest.data(), n)
      .cwiseMax(1e-6 * Eigen::Map<const Eigen::VectorXd>(typical_.data(), n));
}

/// Carries deviations through the last step. After a switch: if all of them are shifts in time, M = f rho with f the
/// rate, nothing else has to be carried.
void ReturnMap::carry(Result& result, March& march) {
  constexpr double rounding = 1e-11;
  result.factors.push_back(march.last().transition);
  if (result.factors.back().size() == 0) carried_.resize(0, 0);
  if (carried_.size() == 0) return;
  carried_ = result.factors.back() * carried_;
  if (!march.last().switched) return;
  State rate;
  field_->rate(march.x(), rate, march.t());
  const Eigen::VectorXd size = sizes(result);
  const Eigen::VectorXd f = Eigen::Map<const Eigen::VectorXd>(rate.data(), size.size()).cwiseQuotient(size);
  const Eigen::MatrixXd M = size.cwiseInverse().asDiagonal() * carried_;
  if (!(f.squaredNorm() > 0.0)) return;
  const Eigen::RowVectorXd rho = f.transpose() * M / f.squaredNorm();
  if ((M - f * rho).norm() > rounding * M.norm()) return;
  result.time_shift = rho;
  march.track(false);
}

/// Product of the factors, and the gradients of the extremes on the way.
Eigen::MatrixXd ReturnMap::product(Result& result) const {
  const auto n = std::ssize(typical_);
  Eigen::MatrixXd whole = Eigen::MatrixXd::Identity(n, n);
  // An extreme moves with the state there; its moment does not matter, since y stands still.
  const auto extreme = [&](double at, std::size_t step, const Eigen::MatrixXd& next, Eigen::RowVectorXd& gradient) {
    const double share = at - static_cast<double>(step);
    if (!options_.extremes || share < 0.0 || share > 1.0) return;
    if (at == 0.0 || at == static_cast<double>(result.factors.size()))  // on the section, or in shifts of time
      gradient = Eigen::RowVectorXd::Zero(n);
    else
      gradient = loop_->C_y * ((1.0 - share) * whole + share * next).topRows(loop_->states());
  };
  for (auto* gradient : {&result.low_gradient, &result.high_gradient})
    if (options_.extremes && result.time_shift) *gradient = Eigen::RowVectorXd::Zero(n);
  for (std::size_t k = 0; k < result.factors.size(); ++k) {
    const Eigen::MatrixXd next = result.factors[k] * whole;
    extreme(result.extremes.low_at, k, next, result.low_gradient);
    extreme(result.extremes.high_at, k, next, result.high_gradient);
    whole = next;
  }
  return whole;
}

/// Projects along the flow onto the section, multiplies the factors, and checks that the derivative carries the flow to
/// itself.
void ReturnMap::close_derivative(Result& result, const LoopState& from, const Section& target) {
  for (const auto& factor : result.factors)
    if (factor.size() == 0) return result.factors.clear();
  const auto n = static_cast<Eigen::Index>(from.x.size());
  State rate_start, rate_end;
  field_->rate(result.state.x, rate_end, 0.0);
  field_->modes() = from.modes;
  field_->rate(from.x, rate_start, 0.0);
  const Eigen::Map<const Eigen::VectorXd> f0(rate_start.data(), n), f1(rate_end.data(), n);
  Eigen::RowVectorXd normal = Eigen::RowVectorXd::Zero(n);
  normal.head(target.C.size()) = target.C;
  Eigen::MatrixXd whole = product(result);
  const Eigen::VectorXd size = sizes(result);
  if (result.time_shift) {  // the least change with which the motion at the start shifts as it should
    const Eigen::VectorXd along = f0.cwiseQuotient(size);
    const Eigen::RowVectorXd dual = along.cwiseQuotient(size).transpose() / along.squaredNorm();
    *result.time_shift += (1.0 - result.time_shift->dot(f0)) * dual;
    whole = f1 * *result.time_shift;
    result.factors = {whole};
  }
  result.flow_defect = (whole * f0 - f1).cwiseQuotient(size).norm() / f1.cwiseQuotient(size).norm();
  result.time_gradient = -normal * whole / (normal * f1);
  result.derivative = whole + f1 * result.time_gradient;
  if (result.time_shift) result.derivative.setZero();
}

/// Middle of the swing: the centre of reflection of a half map, else halfway between the extremes.
double ReturnMap::middle(const Result& result) const {
  if (half_) return (section_.C * half_->centre).value();
  return 0.5 * (result.extremes.low + result.extremes.high);
}

double ReturnMap::amplitude(const Result& result) const {
  return std::max(result.extremes.high - middle(result), middle(result) - result.extremes.low);
}

Eigen::RowVectorXd ReturnMap::amplitude_gradient(const Result& result) const {
  if (!half_) return 0.5 * (result.high_gradient - result.low_gradient);
  const bool above = result.extremes.high - middle(result) >= middle(result) - result.extremes.low;
  return above ? result.high_gradient : -result.low_gradient;
}

ReturnMap::Result ReturnMap::approach(const LoopState& from) { return run(from, section_); }

ReturnMap::Result ReturnMap::operator()(const LoopState& from) {
  Result all = once(from);
  for (int k = 1; k < options_.returns && all.status == Status::converged; ++k) {
    Result next = once(all.state);
    for (std::size_t i = 0; i < next.largest.size(); ++i) next.largest[i] = std::max(next.largest[i], all.largest[i]);
    next.extremes.include(all.extremes.low);
    next.extremes.include(all.extremes.high);
    next.trace = {};
    next.time += all.time;
    if (all.derivative.size() == 0 ||
        next.derivative.size() == 0) {  // at a grazed switch, or where the map ended early
      next.factors.clear();
      next.derivative.resize(0, 0);
    } else {
      next.time_gradient = (all.time_gradient + next.time_gradient * all.derivative).eval();
      next.derivative = (next.derivative * all.derivative).eval();
      next.factors.insert(next.factors.begin(), all.factors.begin(), all.factors.end());
      next.flow_defect = std::max(next.flow_defect, all.flow_defect);
    }
    all = std::move(next);
  }
  return all;
}

ReturnMap::Result ReturnMap::once(const LoopState& from) {
  if (!half_) return run(from, section_);
  const double middle = (section_.C * half_->centre).value();
  Result result = run(from, Section{section_.C, 2.0 * middle - section_.level, -section_.direction});
  result.state = half_->of(*loop_, result.state);
  if (result.derivative.size() > 0) {
    const Eigen::VectorXd sign = Reflection::signs(*loop_);
    result.derivative = sign.asDiagonal() * result.derivative;
    result.factors.back() = sign.asDiagonal() * result.factors.back();
  }
  return result;
}

}  // namespace limcycle
