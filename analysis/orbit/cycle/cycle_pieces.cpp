#include "limcycle/analysis/orbit/cycle/cycle_pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "limcycle/analysis/motion/steppers/transition.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double longest_panel = 1.0 / 32.0;  ///< of a quadrature, in periods

/// Marches and cuts.
class Cutter {
 public:
  Cutter(const Loop& loop, ParameterRates& rates, const CutOptions& options)
      : rates_(rates),
        field_(loop),
        flow_(field_),
        exact_(choose_stepper(loop, options.rtol) == StepperKind::exact),
        typical_(options.typical ? *options.typical : typical_sizes(loop)),
        march_(field_, exact_ ? StepperKind::exact : StepperKind::rodas5p, loop_weights(loop, options.rtol, typical_)),
        options_(options) {
    output_ = Eigen::RowVectorXd::Zero(std::ssize(typical_));
    output_.head(loop.states()) = loop.C_y;
    result_.sizes = 1e-6 * Eigen::Map<const VectorXd>(typical_.data(), std::ssize(typical_));
  }

  CyclePieces operator()(const LoopState& start, double period) {
    field_.modes() = start.modes;
    period_ = period;
    march_.begin(start.x, 0.0);
    include(start.x);
    while (march_.t() < period && result_.status == Status::converged) {
      if (options_.stop && options_.stop()) result_.status = Status::interrupted;
      if (march_.steps() > options_.max_steps) result_.status = Status::max_iterations;
      if (result_.status == Status::converged) result_.status = advance(period);
    }
    result_.last = {march_.x(), field_.modes()};
    return std::move(result_);
  }

 private:
  /// One step of the march, in pieces.
  Status advance(double period) {
    const auto before = field_.modes();
    if (const Status status = march_.step(period); status != Status::converged) return status;
    const auto after = field_.modes();
    field_.modes() = before;
    Step rest = march_.last();
    for (const double share : cuts(rest)) {
      Step part = rest;
      march_.within(share, part.x1);
      part.t1 = march_.last().t0 + share * (march_.last().t1 - march_.last().t0);
      field_.rate(part.x1, part.dx1, part.t1);
      rest.t0 = part.t1;
      rest.x0 = part.x1;
      rest.dx0 = part.dx1;
      append(part, before);
      mark_reversal(result_.pieces.back());
    }
    append(rest, before);
    include(rest.x1);
    const bool crossed = !march_.last().switched || cross(*march_.last().switched, after);
    field_.modes() = after;
    return crossed && result_.pieces.back().factor.allFinite() ? Status::converged : Status::stalled;
  }

  void append(const Step& step, const std::vector<Mode>& modes) {
    const Index n = std::ssize(step.x0), count = rates_.count();
    CyclePiece piece{step, modes, {}, {}, {}, {}, {}, {}};
    if (exact_) {
      go_exactly(piece);
    } else {
      StageReadings readings;
      if (options_.read_output) readings.row = output_;
      const MatrixXd both = transition(
          field_, step, count,
          [this](const State& x, const MatrixXd& J, double t, MatrixXd& columns) {
            rates_.rates(field_, x, J, t, columns);
          },
          options_.read_output ? &readings : nullptr);
      piece.factor = both.leftCols(n);
      piece.columns = both.rightCols(count);
      if (options_.read_output) read(piece, readings);
    }
    result_.pieces.push_back(std::move(piece));
  }

  /// Covers a piece with the exact flow.
  void go_exactly(CyclePiece& piece) {
    const Index n = std::ssize(piece.step.x0);
    const double h = piece.step.t1 - piece.step.t0;
    piece.factor = flow_.over_step(h).topLeftCorner(n, n);
    piece.columns = rates_.over(field_, piece.step.x0, h);
    if (options_.read_output) read_exactly(piece);
  }

  /// The readings of such a piece, by Boole's rule over panels that are short compared with the period, even for a
  /// straight motion, because the integrands contain e^{-jwt}.
  void read_exactly(CyclePiece& piece) {
    constexpr std::array<double, 4> boole{14.0 / 90.0, 32.0 / 90.0, 12.0 / 90.0, 32.0 / 90.0};
    const Index n = std::ssize(piece.step.x0);
    const double length = piece.step.t1 - piece.step.t0;
    int parts = 4;
    while (length > 0.25 * parts * longest_panel * period_) parts *= 2;
    const double h = length / parts;
    const MatrixXd part = flow_.over_step(h);
    MatrixXd factor = MatrixXd::Identity(n, n), columns = MatrixXd::Zero(n, rates_.count());
    State x = piece.step.x0, next;
    for (int i = 0; i <= parts; ++i) {
      const double weight = (i == 0 || i == parts ? 0.5 : 1.0) * boole[static_cast<std::size_t>(i % 4)] * 4.0 * h;
      piece.readings.push_back(
          {piece.step.t0 + i * h, weight, field_.y(x), output_ * factor, output_ * columns + rates_.output(x)});
      if (i == parts) return;
      columns = (part.topLeftCorner(n, n) * columns + rates_.over(field_, x, h)).eval();
      factor = (part.topLeftCorner(n, n) * factor).eval();
      AffineFlow::apply(part, x, next);
      std::swap(x, next);
    }
  }

  /// The readings at the stages of a step.
  void read(CyclePiece& piece, const StageReadings& readings) {
    const Index n = std::ssize(piece.step.x0);
    const double length = piece.step.t1 - piece.step.t0;
    State x;
    for (Index i = 0; i < StageReadings::count; ++i) {
      const double share = StageReadings::node(i);
      piece.step.interpolate(share, x);
      piece.readings.push_back({piece.step.t0 + share * length, StageReadings::weight(i) * length, field_.y(x),
                                readings.at.row(i).head(n),
                                readings.at.row(i).tail(rates_.count()) + rates_.output(x)});
    }
  }

  /// Shares of the last step, in order, at which y turns or the rubbing velocity reverses.
  std::vector<double> cuts(const Step& step) {
    std::vector<double> found;
    const auto add = [&](auto&& value) {
      const double first = value(step.x0, step.dx0), last = value(step.x1, step.dx1);
      if (!(first * last < 0.0)) return;
      const double share = zero(value, first, last);
      const auto near = [share](double other) { return std::abs(other - share) < 1e-7; };
      if (share > 1e-7 && share < 1.0 - 1e-7 && std::ranges::none_of(found, near)) found.push_back(share);
    };
    add([this](const State& x, const State&) {
      State dx;
      field_.rate(x, dx, march_.last().t0);
      return rates_.rubbing_velocity(field_);
    });
    add([this](const State&, const State& dx) { return field_.y_rate(dx); });
    std::ranges::sort(found);
    return found;
  }

  /// Share of the last step at which `value` is almost zero and still has its initial sign: a billionth of its first
  /// value is left, so that no rounding, here or in a neighbour, puts it on the other side.
  template <class Value>
  double zero(const Value& value, double first, double last) {
    const double left = 1e-9 * first, sign = first < 0.0 ? -1.0 : 1.0;
    double low = 0.0, high = 1.0, at_low = first - left, at_high = last - left;
    State x, dx;
    // Illinois: the end that stays counts half the next time.
    for (int i = 0, stayed = 0; i < 60 && high - low > 1e-15; ++i) {
      double share = low + (high - low) * at_low / (at_low - at_high);
      if (!(share > low && share < high)) share = 0.5 * (low + high);
      march_.within(share, x);
      field_.rate(x, dx, march_.last().t0);
      const double here = value(x, dx) - left;
      if (std::abs(here) < 0.1 * std::abs(left)) return share;
      const bool before = sign * here > 0.0;
      (before ? low : high) = share;
      (before ? at_low : at_high) = here;
      const int side = before ? 1 : -1;
      if (stayed == side) (before ? at_high : at_low) *= 0.5;
      stayed = side;
    }
    return low;
  }

  /// Records the moment at the end of a piece, if the rubbing velocity reverses there.
  void mark_reversal(CyclePiece& piece) {
    const State& x = piece.step.x1;
    State dx;
    field_.rate(x, dx, piece.step.t1);
    const auto rub = rates_.rubbing(field_, x, piece.step.t1);
    if (!rub) return;
    const double speed = rub->by_state * Eigen::Map<const VectorXd>(dx.data(), std::ssize(dx));
    const double span = std::abs(speed) * (march_.last().t1 - march_.last().t0);
    if (!(std::abs(rub->velocity) < 1e-7 * span)) return;  // it is y that turns
    piece.reversal = rub->velocity;
    piece.end = BoundMoment{-rub->by_state / speed, -rub->by_parameters / speed};
  }

  /// The switch at the end of the last piece, which leads to the modes `after`. The march does not report which guard
  /// it was.
  bool cross(std::size_t element, const std::vector<Mode>& after) {
    CyclePiece& piece = result_.pieces.back();
    const Step& step = piece.step;
    std::vector<double> values;
    field_.guards(step.x1, step.t1, values);
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < values.size(); ++k)
      if (field_.owner(k) == element) order.push_back(k);
    std::ranges::sort(order, {}, [&](std::size_t k) { return values[k]; });
    for (const std::size_t guard : order) {
      State x = step.x1, dx;
      SwitchSlopes slopes;
      field_.modes() = piece.modes;
      if (!field_.fire(x, step.t1, guard, slopes) || field_.modes() != after) continue;
      field_.modes() = piece.modes;
      field_.rate(step.x1, dx, step.t1);
      auto added = rates_.at_switch(field_, step.x1, step.t1, guard, slopes, after);
      if (!added) return false;
      piece.end = BoundMoment{-slopes.guard / slopes.crossing, -added->guard / slopes.crossing};
      piece.event = CyclePiece::Switch{guard, std::move(slopes.saltation), std::move(added->jump)};
      return true;
    }
    return false;
  }

  void include(const State& x) {
    result_.sizes = result_.sizes.cwiseMax(Eigen::Map<const VectorXd>(x.data(), std::ssize(x)).cwiseAbs());
  }

  ParameterRates& rates_;
  LoopField field_;
  AffineFlow flow_;
  bool exact_;
  double period_ = 0.0;
  State typical_;
  March march_;
  const CutOptions& options_;
  Eigen::RowVectorXd output_;  ///< y of the states
  CyclePieces result_;
};

}  // namespace

CyclePieces cut_cycle(const Loop& loop, const LoopState& start, double period, ParameterRates& rates,
                      const CutOptions& options) {
  return Cutter(loop, rates, options)(start, period);
}

}  // namespace limcycle
