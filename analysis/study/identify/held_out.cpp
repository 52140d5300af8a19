#include "limcycle/analysis/study/identify/held_out.hpp"

#include <cmath>

#include "limcycle/analysis/study/identify/bounded_fit.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

constexpr Eigen::Index folds = 5, blocks_a_fold = 4;

/// Weight 1 for the entries of one part. Each record is cut into 20 blocks, dealt out in turn.
Eigen::VectorXd part_of(const Misfit& misfit, Eigen::Index part) {
  Eigen::VectorXd chosen = Eigen::VectorXd::Zero(misfit.size());
  for (std::size_t r = 0; r < misfit.records().size(); ++r) {
    const Eigen::Index rows = std::ssize(misfit.records()[r].compared);
    for (Eigen::Index i = 0; i < rows; ++i)
      if (i * folds * blocks_a_fold / rows % folds == part) chosen(misfit.first_of(r) + i) = 1.0;
  }
  return chosen;
}

/// The step to the fit of the entries with weight 1 in `in`, along `groups`. What these entries do not determine stays
/// where it is.
Eigen::VectorXd step_to_fit(const Groups& groups, const Eigen::VectorXd& in, const Eigen::VectorXd& entries,
                            const Eigen::MatrixXd& slopes) {
  if (groups.empty()) return Eigen::VectorXd::Zero(slopes.cols());
  Eigen::MatrixXd by_group = Eigen::MatrixXd::Zero(slopes.rows(), std::ssize(groups));
  for (Eigen::Index g = 0; g < by_group.cols(); ++g)
    for (const auto k : groups[static_cast<std::size_t>(g)]) by_group.col(g) += slopes.col(k);
  const Eigen::VectorXd along = least_squares(in.asDiagonal() * by_group, in.cwiseProduct(entries), 1e-4);
  Eigen::VectorXd step = Eigen::VectorXd::Zero(slopes.cols());
  for (Eigen::Index g = 0; g < by_group.cols(); ++g)
    for (const auto k : groups[static_cast<std::size_t>(g)]) step(k) = along(g);
  return step;
}

}  // namespace

double held_out_error(const Misfit& misfit, const Fit& best) {
  Eigen::VectorXd entries, there;
  Eigen::MatrixXd slopes;
  if (!misfit.at(best.u, entries, &slopes)) return NAN;
  Eigen::VectorXd u = best.u;
  const Groups groups = groups_on(misfit.space(), best.held, felt_coordinates(misfit, u), u);
  double sum = 0.0, rows = 0.0;
  for (Eigen::Index part = 0; part < folds; ++part) {
    const Eigen::VectorXd out = part_of(misfit, part), in = Eigen::VectorXd::Ones(out.size()) - out;
    if (misfit.start_states() > 0 && !misfit.at(best.u, entries, &slopes, 1.0, &in)) return NAN;
    Eigen::VectorXd step = step_to_fit(groups, in, entries, slopes);
    // Along what is hardly determined a step may leave the laws that there are; at their very edge none is left.
    for (int halvings = 0; !misfit.at(put_within(misfit.space(), best.u - step), there, nullptr, 1.0, &in);
         ++halvings) {
      if (step.isZero(0.0)) return NAN;
      step *= halvings < 10 ? 0.5 : 0.0;
    }
    for (std::size_t r = 0; r < misfit.records().size(); ++r) {
      const double unit = misfit.noise()[r] / misfit.records()[r].size;
      const Eigen::Index count = std::ssize(misfit.records()[r].compared), first = misfit.first_of(r);
      sum += unit * unit * there.segment(first, count).cwiseProduct(out.segment(first, count)).squaredNorm();
      rows += out.segment(first, count).sum();
    }
  }
  return std::sqrt(sum / rows);
}

}  // namespace limcycle
