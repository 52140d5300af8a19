#include "limcycle/analysis/orbit/derivatives/cycle_derivatives.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "limcycle/analysis/orbit/cycle/cycle_equations.hpp"
#include "limcycle/analysis/orbit/cycle/cycle_pieces.hpp"
#include "limcycle/analysis/orbit/derivatives/multiplier_derivatives.hpp"
#include "limcycle/analysis/orbit/derivatives/output_derivatives.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

constexpr double looser = 30.0;  ///< the second integration
/// Share of the difference of the two that is stated: errors go about as the tolerance to the power 0.8 (those of the
/// interpolated steps), so that the difference is about 14 times the error of the tight integration; five times that
/// error is stated.
constexpr double stated = 0.35;
/// Errors of differences of equations: of the derivative itself, and of the size of the quantity over the step.
constexpr double truncated = 1e-9, rounded = 1e-14;
/// Error of a multiplier's derivative from differences of the step derivatives, per square of the relative step of the
/// parameter and per multiplier over parameter: measured on the LuGre servo, whose bristles are fast compared with its
/// period.
constexpr double of_factors = 2e7;

VectorXd as_column(const State& x) { return Eigen::Map<const VectorXd>(x.data(), std::ssize(x)); }

/// dy/dx0 and dy/dp where y is largest or least.
struct Extreme {
  double y;
  RowVectorXd by_start, by_parameters;
};

/// Effect of one period on deviations of its start and on parameters.
struct Carried {
  MatrixXd whole, columns;
  Extreme low{infinite, {}, {}}, high{-infinite, {}, {}};
};

/// Over half a period: the extremes of the other half are those of this one, reflected.
void reflect_extreme(const Loop& loop, const ParameterRates& rates, const CycleMirror& mirror, Carried& carried) {
  const Index linear = loop.states();
  const double middle = loop.C_y.dot(mirror.centre.head(linear));
  const State at(mirror.centre.begin(), mirror.centre.end());
  const RowVectorXd moves = loop.C_y * mirror.moved.topRows(linear) + rates.output(at);
  const bool upper = carried.high.y - middle > middle - carried.low.y;
  const Extreme& here = upper ? carried.high : carried.low;
  Extreme& there = upper ? carried.low : carried.high;
  there = {2.0 * middle - here.y, -here.by_start, 2.0 * moves - here.by_parameters};
}

Carried carry(const Loop& loop, const ParameterRates& rates, const CyclePieces& cut) {
  const Index n = cut.sizes.size(), linear = loop.states();
  Carried carried{MatrixXd::Identity(n, n), MatrixXd::Zero(n, rates.count())};
  for (const CyclePiece& piece : cut.pieces) {
    carried.whole = (piece.factor * carried.whole).eval();
    carried.columns = (piece.factor * carried.columns + piece.columns).eval();
    const double y = loop.C_y.dot(as_column(piece.step.x1).head(linear));
    if (y < carried.low.y || y > carried.high.y) {
      Extreme here{y, loop.C_y * carried.whole.topRows(linear),
                   loop.C_y * carried.columns.topRows(linear) + rates.output(piece.step.x1)};
      if (piece.end) {  // y may have a corner, and the corner moves
        const double rate = loop.C_y.dot(as_column(piece.step.dx1).head(linear));
        here.by_start += rate * (piece.end->by_state * carried.whole);
        here.by_parameters += rate * (piece.end->by_state * carried.columns + piece.end->by_parameters);
      }
      if (y < carried.low.y) carried.low = here;
      if (y > carried.high.y) carried.high = std::move(here);
    }
    if (!piece.event) continue;
    carried.whole = (piece.event->saltation * carried.whole).eval();
    carried.columns = (piece.event->saltation * carried.columns + piece.event->jump).eval();
  }
  if (cut.mirror) reflect_extreme(loop, rates, *cut.mirror, carried);
  PeriodMap map{std::move(carried.whole), std::move(carried.columns)};
  reflect(cut, map);
  carried.whole = std::move(map.whole);
  carried.columns = std::move(map.columns);
  return carried;
}

/// dx0/dp, with dT/dp in the last row: a column for each parameter; not finite if there is none (a fold).
MatrixXd solve_cycle(const CyclePieces& cut, const Carried& carried) {
  const Index n = cut.sizes.size();
  const MatrixXd matrix = cycle_matrix(cut, carried.whole);
  MatrixXd right = MatrixXd::Zero(n + 1, carried.columns.cols());
  right.topRows(n) = cut.sizes.cwiseInverse().asDiagonal() * carried.columns;
  MatrixXd solution = solve_columns_fully_pivoted(matrix, right);
  if (!((matrix * solution - right).norm() <= 1e-6 * right.norm())) solution.setConstant(infinite);
  solution.topRows(n) = (cut.sizes.asDiagonal() * solution.topRows(n)).eval();
  solution.row(n) /= as_column(cut.pieces.front().step.dx0).cwiseQuotient(cut.sizes).norm();
  return solution;
}

CycleDerivatives without(Status status, std::string why) { return {status, std::move(why), {}}; }

CycleDerivatives derive(const Loop& loop, const Cycle& cycle, const std::optional<CycleMirror>& mirror,
                        ParameterRates& rates, double rtol, const CycleDerivativeOptions& options) {
  const CyclePieces cut = cut_period(loop, cycle, mirror, rates, {rtol, options.max_steps, options.stop, true, {}});
  if (cut.status == Status::stalled)
    return without(cut.status, "a switch is grazed, or comes in another order beside the cycle");
  if (cut.status != Status::converged) return without(cut.status, "the cycle could not be followed");
  if (!closes(cut, cycle.start)) return without(Status::stalled, "the motion does not close after the period");
  const Carried carried = carry(loop, rates, cut);
  const MatrixXd solution = solve_cycle(cut, carried);
  if (!solution.allFinite()) return without(Status::stalled, "the equations of the cycle are singular: a fold");
  const Index n = cut.sizes.size();
  const RowVectorXd by_start = 0.5 * (carried.high.by_start - carried.low.by_start);
  const RowVectorXd amplitude =
      0.5 * (carried.high.by_parameters - carried.low.by_parameters) + by_start * solution.topRows(n);
  const OutputDerivatives output = output_derivatives(loop, cut, rates, solution);
  CycleDerivatives result;
  for (Index k = 0; k < rates.count(); ++k) {
    CycleDerivative& one = result.by.emplace_back();
    one.period = (mirror ? 2.0 : 1.0) * solution(n, k);
    one.amplitude = amplitude(k);
    one.first_harmonic = output.by_first_harmonic(k);
    one.offset = output.by_mean(k);
  }
  if (!options.multipliers) return result;
  const auto moved = multiplier_derivatives(cut, cycle.multipliers, solution, rates);
  for (std::size_t k = 0; k < moved.size(); ++k) result.by[k].multipliers = moved[k];
  return result;
}

/// Errors by comparison with a looser integration.
void compare(const CycleDerivatives& rough, const Cycle& cycle, const ParameterRates& rates, CycleDerivatives& result) {
  for (std::size_t k = 0; k < result.by.size(); ++k) {
    CycleDerivative& one = result.by[k];
    const CycleDerivative& other = rough.by[k];
    const auto parameter = static_cast<Index>(k);
    const double step = std::abs(rates.step(parameter)), part = rates.share(parameter);
    const double bent = std::max(0.0, rates.bend(parameter) - 1e-3) * part * part;
    const double grain = (rounded + bent) / step, coarse = of_factors * part * part * part / step;
    const auto error = [&](auto a, auto b, double size) {
      return stated * std::abs(a - b) + truncated * std::abs(a) + grain * size;
    };
    one.period_error = error(one.period, other.period, cycle.period);
    one.amplitude_error = error(one.amplitude, other.amplitude, cycle.amplitude);
    one.first_harmonic_error = error(one.first_harmonic, other.first_harmonic, cycle.first_harmonic);
    one.offset_error = error(one.offset, other.offset, cycle.amplitude + std::abs(cycle.offset));
    for (std::size_t m = 0; m < one.multipliers.size(); ++m) {
      auto& value = one.multipliers[m];
      const auto& rough_value = other.multipliers[m];
      if (!rough_value) value.reset();  // an unknown error
      if (!value) continue;
      const double size = std::max(1e-3, std::abs(cycle.multipliers[m]));  // of the sum up to this multiplier
      one.multiplier_error =
          std::max(one.multiplier_error, error(*value, *rough_value, size) + coarse * std::abs(cycle.multipliers[m]));
    }
  }
}

}  // namespace

CycleDerivatives cycle_derivatives(const Loop& loop, const Cycle& cycle,
                                   std::span<const ParameterNeighbours> neighbours,
                                   const CycleDerivativeOptions& options) {
  ParameterRates rates(loop, neighbours);
  if (cycle.remembered > 0)
    return without(Status::undefined, "the cycle keeps something of what was before: another history, another cycle");
  const auto mirror = common_mirror(loop, cycle, neighbours);
  CycleDerivatives result = derive(loop, cycle, mirror, rates, options.rtol, options);
  if (result.status != Status::converged) return result;
  CycleDerivatives rough = derive(loop, cycle, mirror, rates, looser * options.rtol, options);
  if (rough.status != Status::converged) return rough;
  compare(rough, cycle, rates, result);
  return result;
}

}  // namespace limcycle
