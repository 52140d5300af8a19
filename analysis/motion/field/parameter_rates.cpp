#include "limcycle/analysis/motion/field/parameter_rates.hpp"

#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/motion/steppers/transition.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Eigen::Map<const VectorXd> as_vector(const State& x) { return {x.data(), std::ssize(x)}; }

}  // namespace

ParameterRates::ParameterRates(const Loop& loop, std::span<const ParameterNeighbours> neighbours)
    : loop_(&loop), affine_(AffineFlow::applies(loop)) {
  const LoopField field(loop);
  for (std::size_t i = 0; i < loop.ports.size(); ++i)
    if (loop.ports[i].rubs && !loop.ports[i].C_v.isZero()) rubbing_ = i;
  const auto side = [&](const Loop& of) {
    auto made = std::make_unique<Side>(of);
    if (made->field.size() != field.size() || of.states() != loop.states() ||
        made->field.modes().size() != field.modes().size())
      throw std::invalid_argument("a neighbour in a parameter has another number of states or elements");
    return made;
  };
  for (const auto& pair : neighbours) {
    if (!std::isfinite(pair.step) || pair.step == 0.0 || !std::isfinite(pair.value))
      throw std::invalid_argument("the step of a parameter must be finite and not 0");
    const double share = pair.value != 0.0 ? std::abs(pair.step / pair.value) : 1e-6;
    pairs_.push_back({side(pair.low), side(pair.high), pair.step, share});
  }
}

/// Moves x until a neighbour rubs at this velocity, and leaves the neighbour evaluated there, with its rate in rate_.
VectorXd ParameterRates::meet(Side& side, double velocity_there, State& x, double t) {
  VectorXd by = VectorXd::Zero(std::ssize(x));
  side.field.rate(x, rate_, t);
  const double lacking = velocity_there - velocity(side.field);
  if (lacking == 0.0 || !rubbing_) return by;
  const auto& row = side.loop->ports[*rubbing_].C_v;
  by.head(row.size()) = row.transpose() * (lacking / row.squaredNorm());
  Eigen::Map<VectorXd>(x.data(), by.size()) += by;
  side.field.rate(x, rate_, t);
  return by;
}

/// Puts a neighbour in the modes of `field`, last evaluated at x, and moved_ to where it rubs at the same velocity.
/// Returns the displacement; the neighbour is left evaluated there, with its rate in rate_.
VectorXd ParameterRates::move(Side& side, const LoopField& field, const State& x, double t) {
  side.field.modes() = field.modes();
  moved_ = x;
  return meet(side, velocity(field), moved_, t);
}

void ParameterRates::rates(const LoopField& field, const State& x, const MatrixXd& J, double t, MatrixXd& columns) {
  columns.resize(std::ssize(x), count());
  for (Index k = 0; k < count(); ++k) {
    auto& [low, high, step, share] = pairs_[static_cast<std::size_t>(k)];
    VectorXd by = move(*high, field, x, t);
    columns.col(k) = as_vector(rate_);
    by -= move(*low, field, x, t);
    columns.col(k) -= as_vector(rate_);
    if (!by.isZero(0.0)) columns.col(k) -= J * by;
    columns.col(k) /= 2.0 * step;
  }
}

MatrixXd ParameterRates::over(const LoopField& field, const State& x, double h) {
  MatrixXd columns(std::ssize(x), count());
  State end;
  const auto arrive = [&](Side& side) {
    side.field.modes() = field.modes();
    AffineFlow::apply(side.flow.over_step(h), x, end);
    return VectorXd(as_vector(end));
  };
  for (Index k = 0; k < count(); ++k) {
    auto& [low, high, step, share] = pairs_[static_cast<std::size_t>(k)];
    columns.col(k) = (arrive(*high) - arrive(*low)) / (2.0 * step);
  }
  return columns;
}

std::optional<ParameterRates::AtSwitch> ParameterRates::at_switch(const LoopField& field, const State& x, double t,
                                                                  std::size_t guard, const SwitchSlopes& slopes,
                                                                  const std::vector<Mode>& after) {
  const Index n = std::ssize(x);
  AtSwitch result{MatrixXd(n, count()), Eigen::RowVectorXd(count())};
  for (Index k = 0; k < count(); ++k) {
    auto& [low, high, step, share] = pairs_[static_cast<std::size_t>(k)];
    VectorXd reset = VectorXd::Zero(n);
    double value = 0.0;
    for (const bool up : {true, false}) {
      Side& side = up ? *high : *low;
      const double weight = (up ? 0.5 : -0.5) / step;
      const VectorXd by = move(side, field, x, t);
      side.field.guards(moved_, t, guards_);
      value += weight * (guards_.at(guard) - slopes.guard * by);
      side.field.fire(moved_, t, guard);
      if (side.field.modes() != after) return std::nullopt;
      reset += weight * (as_vector(moved_) - slopes.reset * by);
    }
    result.guard(k) = value;
    result.jump.col(k) = reset + (slopes.after - slopes.reset * slopes.before) * (value / slopes.crossing);
  }
  return result;
}

std::optional<ParameterRates::Rubbing> ParameterRates::rubbing(const LoopField& field, const State& x, double t) {
  if (!rubbing_) return std::nullopt;
  Rubbing found{velocity(field), Eigen::RowVectorXd::Zero(std::ssize(x)), Eigen::RowVectorXd(count())};
  found.by_state.head(loop_->states()) = loop_->ports[*rubbing_].C_v;
  for (Index k = 0; k < count(); ++k) {
    auto& [low, high, step, share] = pairs_[static_cast<std::size_t>(k)];
    for (Side* side : {low.get(), high.get()}) {
      side->field.modes() = field.modes();
      side->field.rate(x, rate_, t);
    }
    found.by_parameters(k) = (velocity(high->field) - velocity(low->field)) / (2.0 * step);
  }
  return found;
}

MatrixXd ParameterRates::transition_beside(Index k, bool above, const std::vector<Mode>& modes, Step& step,
                                           std::optional<double> velocity_there) {
  const Index n = std::ssize(step.x0);
  auto& pair = pairs_[static_cast<std::size_t>(k)];
  Side& side = above ? *pair.high : *pair.low;
  side.field.modes() = modes;
  if (velocity_there) meet(side, *velocity_there, step.x1, step.t1);
  side.field.rate(step.x0, step.dx0, step.t0);
  side.field.rate(step.x1, step.dx1, step.t1);
  if (affine_) return side.flow.over_step(step.t1 - step.t0).topLeftCorner(n, n);
  return transition(side.field, step);
}

double ParameterRates::bend(Index k) const {
  const auto& pair = pairs_[static_cast<std::size_t>(k)];
  const Loop &low = *pair.low->loop, &high = *pair.high->loop;
  double bent = 0.0, differs = 0.0;
  const auto compare = [&](const auto& below, const auto& here, const auto& above) {
    bent += (above - 2.0 * here + below).squaredNorm();
    differs += (above - below).squaredNorm();
  };
  compare(low.A, loop_->A, high.A);
  compare(low.B, loop_->B, high.B);
  compare(low.C_y, loop_->C_y, high.C_y);
  return differs > 0.0 ? std::sqrt(bent / differs) : 0.0;
}

Eigen::RowVectorXd ParameterRates::output(const State& x) const {
  Eigen::RowVectorXd change(count());
  const auto X = as_vector(x).head(loop_->states());
  for (Index k = 0; k < count(); ++k) {
    const auto& [low, high, step, share] = pairs_[static_cast<std::size_t>(k)];
    const double moved = high->loop->output_origin - low->loop->output_origin;
    change(k) = (moved + ((high->loop->C_y - low->loop->C_y) * X).value()) / (2.0 * step);
  }
  return change;
}

}  // namespace limcycle
