#include "limcycle/analysis/study/identify/free/free_response.hpp"

#include <cmath>

#include "limcycle/analysis/study/identify/free/free_march.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

FreeResponse::FreeResponse(const Element& law, std::vector<LawNumber> numbers, std::vector<std::size_t> own_rows,
                           Shooting shooting, std::function<bool()> stop)
    : slopes_(number_slopes_of(law, std::move(numbers), std::move(own_rows))),
      shooting_(shooting),
      stop_(std::move(stop)) {}

/// A window with the state at its start fitted.
struct FreeResponse::WindowFit {
  FreeMarch& march;
  const FreeWindow& window;
  const std::vector<Series>& series;
  const VectorXd* known;
  Eigen::Vector2d state_sizes;  ///< ranges of the motion
  FreeRun run = {};
  VectorXd entries = {};      ///< the samples of each series in turn
  MatrixXd slopes = {};       ///< by numbers, then by the state at the start
  VectorXd row_weights = {};  ///< of the measured rows
  VectorXd weights = {};      ///< 1 for known entries
  bool by_own_rows = false;

  Index samples() const { return std::ssize(run.samples); }
  Index place(std::size_t s, Index i) const {
    return series[s].first + static_cast<Index>(run.samples[static_cast<std::size_t>(i)]);
  }

  bool simulate(const Eigen::Vector2d& start) {
    if (!march.run(window, start, run)) return false;
    const Index n = samples(), all = n * std::ssize(series);
    entries.resize(all);
    slopes.resize(all, run.y_slopes.rows());
    row_weights.resize(all);
    for (std::size_t s = 0; s < series.size(); ++s) {
      const auto& record = *series[s].record;
      const bool position = record.quantity == MeasuredQuantity::position;
      const auto& values = position ? run.y : run.rate;
      const Index first = n * static_cast<Index>(s);
      for (Index i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const auto row = static_cast<std::size_t>(run.samples[k]);
        entries(first + i) =
            (values[k] - record.compared[row].measured) * record.compared[row].weight / series[s].noise;
        row_weights(first + i) = record.compared[row].weight;
      }
      slopes.middleRows(first, n) =
          (position ? run.y_slopes : run.rate_slopes).leftCols(n).transpose() / series[s].noise;
      slopes.middleRows(first, n).array().colwise() *= row_weights.segment(first, n).array();
    }
    return entries.allFinite() && slopes.allFinite();
  }

  void weigh() {
    weights.setOnes(entries.size());
    if (known == nullptr) return;
    for (std::size_t s = 0; s < series.size(); ++s)
      for (Index i = 0; i < samples(); ++i) weights(samples() * static_cast<Index>(s) + i) = (*known)(place(s, i));
    by_own_rows = weights.sum() < 4.0;
    if (by_own_rows) weights.setOnes();
  }

  /// The step of the start to the least sum of squares, with the derivative of the start by the numbers.
  struct Step {
    Eigen::Vector2d by;
    MatrixXd with_numbers;
    double decrease;  ///< of the sum of squares, by the linear model
  };
  Step step() const {
    const Index numbers = slopes.cols() - 2;
    MatrixXd right(entries.size(), numbers + 1);
    right << entries, slopes.leftCols(numbers);
    MatrixXd by_start = weights.asDiagonal() * slopes.rightCols(2);
    Eigen::Vector2d sizes = by_start.colwise().norm().transpose();
    for (Index k = 0; k < 2; ++k) {  // what the rows do not show stays where it is: a velocity before the body sticks
      if (sizes(k) * state_sizes(k) > 1.0) continue;
      by_start.col(k).setZero();
      sizes(k) = 1.0;
    }
    const MatrixXd unit = by_start * sizes.cwiseInverse().asDiagonal();
    MatrixXd solved = -(sizes.cwiseInverse().asDiagonal() * least_squares_columns(unit, weights.asDiagonal() * right));
    return {solved.col(0), solved.rightCols(numbers), (by_start * solved.col(0)).squaredNorm()};
  }
  double sum() const { return weights.cwiseProduct(entries).squaredNorm(); }

  /// From `start`, by a few steps at most, each halved until it lowers the sum; `next` gets the step from its end.
  bool fit(Eigen::Vector2d& start, Step& next) {
    constexpr int most_steps = 6, most_halvings = 4;
    if (!simulate(start)) return false;
    weigh();
    next = step();
    for (int i = 0; i < most_steps && !is_small(next); ++i) {
      const double before = sum();
      const Eigen::Vector2d from = start;
      double share = 1.0;
      for (int k = 0; k <= most_halvings; ++k, share *= 0.5) {
        start = from + share * next.by;
        if (simulate(start) && sum() < before) break;
        if (k < most_halvings) continue;
        start = from;  // at a jump: a body that just sticks, or just does not
        if (!simulate(from)) return false;
        next = step();
        next.by.setZero();
        return true;
      }
      next = step();
      if (before - sum() < 1e-3 * before) break;
    }
    if (!is_small(next)) next.by.setZero();
    return true;
  }
  /// The entries are then those of the linear model at its minimum.
  bool is_small(const Step& one) const { return one.decrease <= 1e-3 + 1e-5 * sum(); }
};

bool FreeResponse::run(const Element& law, const std::vector<Series>& series, const VectorXd* known, VectorXd& entries,
                       MatrixXd* slopes, double fineness) {
  const FreeMotion& motion = *series.front().record->motion;
  slopes_->take(law);
  FreeMarch march(motion, law, slopes != nullptr ? slopes_.get() : nullptr, fineness, stop_);
  const auto& list = windows(motion);
  for (std::size_t w = 0; w < list.size(); ++w) {
    const auto kept = kept_.find({&motion, w});
    Eigen::Vector2d start = kept == kept_.end() ? list[w].start : kept->second;
    WindowFit fit{march, list[w], series, known, motion.state_sizes};
    WindowFit::Step following;
    if (!fit.fit(start, following)) return false;
    last_[{&motion, w}] = start;
    const Index n = fit.samples();
    VectorXd left = fit.entries + fit.slopes.rightCols(2) * following.by;
    if (fit.by_own_rows && left.size() > 2)
      left *= std::sqrt(static_cast<double>(left.size()) / static_cast<double>(left.size() - 2));
    for (std::size_t s = 0; s < series.size(); ++s)
      for (Index i = 0; i < n; ++i) {
        const Index row = n * static_cast<Index>(s) + i, place = fit.place(s, i);
        entries(place) = left(row);
        if (slopes == nullptr) continue;
        slopes->row(place) =
            fit.slopes.row(row).head(slopes->cols()) + fit.slopes.row(row).tail(2) * following.with_numbers;
      }
  }
  return true;
}

}  // namespace limcycle
