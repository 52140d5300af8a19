#include "limcycle/analysis/orbit/derivatives/threshold_derivatives.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "limcycle/analysis/orbit/cycle/cycle_equations.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;

constexpr double loose_fold = 30.0;   ///< the second integration, as for cycles (cycle_derivatives.cpp)
constexpr double stated_fold = 0.35;  ///< share of the difference of the two that is stated
/// Off the fold w is rotated, in proportion to the ratio of the two smallest singular values: ten times the rotation
/// measured on more and less precisely located folds of the LuGre servo, as a share of dP/dp.
constexpr double off_fold = 0.03;

ThresholdDerivatives no_threshold(Status status, std::string why) { return {status, std::move(why), {}}; }

/// w . dP/dp of each parameter at a fold, that of the threshold first.
struct FoldRow {
  RowVectorXd pulls, sizes;  ///< and |dP/dp|
  double ratio = 0.0;        ///< of the two smallest singular values
};

std::optional<std::string> fold_row(const Loop& loop, const Cycle& cycle, ParameterRates& rates, double rtol,
                                    const CycleDerivativeOptions& options, FoldRow& row) {
  const CyclePieces cut =
      cut_cycle(loop, cycle.start, cycle.period, rates, {rtol, options.max_steps, options.stop, false, {}});
  if (cut.status == Status::stalled) return "a switch is grazed, or comes in another order beside the cycle";
  if (cut.status != Status::converged) return "the cycle could not be followed";
  if (!closes(cut, cycle.start)) return "the motion does not close after the period";
  const PeriodMap map = period_map(cut);
  const MatrixXd matrix = cycle_matrix(cut, map.whole);
  const auto svd = singular_values(matrix);
  const Index n = cut.sizes.size();
  row.ratio = svd.values(n) / svd.values(n - 1);
  if (!(row.ratio < 1e-3)) return "the branch does not fold there";
  const MatrixXd columns = cut.sizes.cwiseInverse().asDiagonal() * map.columns;
  row.pulls = svd.U.col(n).head(n).transpose() * columns;
  row.sizes = columns.colwise().norm();
  return std::nullopt;
}

ThresholdDerivatives at_fold(const Loop& loop, const Cycle& cycle, const std::vector<ParameterNeighbours>& pairs,
                             const CycleDerivativeOptions& options) {
  if (cycle.remembered > 0) return no_threshold(Status::undefined, "the cycle keeps something of what was before");
  ParameterRates rates(loop, pairs);
  FoldRow tight, rough;
  auto why = fold_row(loop, cycle, rates, options.rtol, options, tight);
  if (!why) why = fold_row(loop, cycle, rates, loose_fold * options.rtol, options, rough);
  if (options.stop && options.stop()) return no_threshold(Status::interrupted, "it was stopped");
  if (why) return no_threshold(Status::stalled, std::move(*why));
  const double own = tight.pulls(0);
  if (!(std::abs(own) > 100.0 * off_fold * tight.ratio * tight.sizes(0)))
    return no_threshold(Status::stalled, "the parameter hardly moves the fold");
  ThresholdDerivatives result;
  for (Index k = 1; k < rates.count(); ++k) {
    const double value = -tight.pulls(k) / own, other = -rough.pulls(k) / rough.pulls(0);
    const double rounding = 1e-14 / std::abs(own) * (1.0 / std::abs(rates.step(k)) + std::abs(value / rates.step(0)));
    const double off = off_fold * tight.ratio * (tight.sizes(k) + std::abs(value) * tight.sizes(0)) / std::abs(own);
    result.by.push_back({value, stated_fold * std::abs(value - other) + 1e-9 * std::abs(value) + off + rounding});
  }
  return result;
}

ThresholdDerivatives at_change_of_stability(const Loop& loop, const Cycle& cycle,
                                            const std::vector<ParameterNeighbours>& pairs,
                                            const CycleDerivativeOptions& options) {
  const auto nearest = std::ranges::min_element(cycle.multipliers, {},
                                                [](std::complex<double> m) { return std::abs(std::abs(m) - 1.0); });
  if (nearest == cycle.multipliers.end() || !(std::abs(std::abs(*nearest) - 1.0) < 1e-2))
    return no_threshold(Status::stalled, "no multiplier is on the unit circle there");
  const auto found = cycle_derivatives(loop, cycle, pairs, options);
  if (found.status != Status::converged) return no_threshold(found.status, found.why);
  const auto which = static_cast<std::size_t>(nearest - cycle.multipliers.begin());
  const std::complex<double> along = std::conj(*nearest) / std::abs(*nearest);
  std::vector<ThresholdDerivative> moved;
  for (const auto& one : found.by) {
    if (!one.multipliers.at(which))
      return no_threshold(Status::stalled, "the multiplier on the unit circle has no derivative");
    moved.push_back({(along * *one.multipliers[which]).real(), one.multiplier_error});
  }
  if (!(std::abs(moved[0].value) > moved[0].error))
    return no_threshold(Status::stalled, "the parameter hardly moves the multiplier");
  ThresholdDerivatives result;
  for (std::size_t k = 1; k < moved.size(); ++k) {
    const double value = -moved[k].value / moved[0].value;
    result.by.push_back({value, (moved[k].error + std::abs(value) * moved[0].error) / std::abs(moved[0].value)});
  }
  return result;
}

}  // namespace

ThresholdDerivatives threshold_derivatives(const Loop& loop, const Cycle& cycle, BranchEvent::Type type,
                                           const ParameterNeighbours& own, std::span<const ParameterNeighbours> others,
                                           const CycleDerivativeOptions& options) {
  if (type == BranchEvent::Type::end)
    return no_threshold(Status::undefined,
                        "the branch ends neither at a fold nor at a change of stability: no equation defines the end");
  std::vector<ParameterNeighbours> pairs{own};
  pairs.insert(pairs.end(), others.begin(), others.end());
  return type == BranchEvent::Type::fold ? at_fold(loop, cycle, pairs, options)
                                         : at_change_of_stability(loop, cycle, pairs, options);
}

}  // namespace limcycle
