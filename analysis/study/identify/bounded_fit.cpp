#include "limcycle/analysis/study/identify/bounded_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

bool is_broken(const Bound& bound, const Eigen::VectorXd& u) { return bound.room(u) < -1e-12; }

/// Adds the bounds that u breaks to `held`. True if there is one that was not among them.
bool hold_broken(const std::vector<Bound>& bounds, const Eigen::VectorXd& u, std::vector<std::size_t>& held) {
  const std::size_t before = held.size();
  for (std::size_t b = 0; b < bounds.size(); ++b)
    if (is_broken(bounds[b], u) && std::ranges::find(held, b) == held.end()) held.push_back(b);
  return held.size() > before;
}

/// Releases the bound that costs most: the multipliers are those with which the pulls of the bounds balance the
/// gradient. True if a step off a bound promises to lower the sum of squares by more than 0.001.
bool release_one(const Misfit& misfit, const std::vector<Bound>& bounds, Fit& on, Eigen::Index fixed) {
  if (on.held.empty()) return false;
  Eigen::VectorXd entries;
  Eigen::MatrixXd slopes;
  if (!misfit.at(on.u, entries, &slopes)) return false;
  Eigen::VectorXd gradient = slopes.transpose() * entries;
  Eigen::MatrixXd pulls = Eigen::MatrixXd::Zero(gradient.size(), std::ssize(on.held));
  for (Eigen::Index j = 0; j < pulls.cols(); ++j) {
    const auto& bound = bounds[on.held[static_cast<std::size_t>(j)]];
    if (bound.above >= 0) pulls(bound.above, j) = 1.0;
    if (bound.below >= 0) pulls(bound.below, j) = -1.0;
  }
  if (fixed >= 0) {
    gradient(fixed) = 0.0;
    pulls.row(fixed).setZero();
  }
  const Eigen::VectorXd multipliers = least_squares(pulls, gradient);
  std::ptrdiff_t worst = -1;
  double largest = 1e-3;
  for (Eigen::Index j = 0; j < pulls.cols(); ++j) {
    const auto& bound = bounds[on.held[static_cast<std::size_t>(j)]];
    const auto moved = bound.above >= 0 && bound.above != fixed ? bound.above : bound.below;
    if (!(multipliers(j) < 0.0) || moved < 0 || moved == fixed) continue;
    const double decrease = std::pow(multipliers(j), 2) / slopes.col(moved).squaredNorm();
    if (!(decrease > largest)) continue;
    largest = decrease;
    worst = j;
  }
  if (worst >= 0) on.held.erase(on.held.begin() + worst);
  return worst >= 0;
}

}  // namespace

Groups groups_on(const ParameterSpace& space, const std::vector<std::size_t>& held,
                 const std::vector<Eigen::Index>& active, Eigen::VectorXd& u, Eigen::Index fixed) {
  const auto bounds = space.bounds();
  const auto n = static_cast<std::size_t>(u.size());
  std::vector<std::size_t> group(n);  // of each coordinate
  std::iota(group.begin(), group.end(), std::size_t{0});
  std::vector<bool> still(n, false);  // groups that do not move
  if (fixed >= 0) still[static_cast<std::size_t>(fixed)] = true;
  const auto join = [&](std::size_t other, std::size_t into) {
    for (std::size_t i = 0; i < n; ++i) {
      if (group[i] != other) continue;
      group[i] = into;
      u(static_cast<Eigen::Index>(i)) = u(static_cast<Eigen::Index>(into));
    }
  };
  for (const auto b : held) {
    if (bounds[b].above >= 0 && bounds[b].below >= 0) continue;
    const auto k = static_cast<std::size_t>(std::max(bounds[b].above, bounds[b].below));
    if (!still[k]) u(static_cast<Eigen::Index>(k)) = bounds[b].at;
    still[k] = true;
  }
  for (const auto b : held) {
    if (bounds[b].above < 0 || bounds[b].below < 0) continue;
    const auto above = group[static_cast<std::size_t>(bounds[b].above)];
    const auto below = group[static_cast<std::size_t>(bounds[b].below)];
    if (above == below || (still[above] && still[below])) continue;
    still[above] ? join(below, above) : join(above, below);
  }
  Groups groups;
  for (std::size_t g = 0; g < n; ++g) {
    std::vector<Eigen::Index> members;
    for (std::size_t i = 0; i < n; ++i)
      if (group[i] == g && !still[g]) members.push_back(static_cast<Eigen::Index>(i));
    const auto moves = [&](Eigen::Index i) { return std::ranges::find(active, i) != active.end(); };
    if (std::ranges::any_of(members, moves)) groups.push_back(std::move(members));
  }
  return groups;
}

Eigen::VectorXd put_within(const ParameterSpace& space, Eigen::VectorXd u, std::vector<std::size_t> held) {
  hold_broken(space.bounds(), u, held);
  groups_on(space, held, {}, u);
  return u;
}

Fit fit_within(const Misfit& misfit, const Fit& from, const std::vector<Eigen::Index>& active, int most_iterations,
               const std::function<bool()>& stop, Eigen::Index fixed) {
  constexpr int most_passes = 12;
  const auto bounds = misfit.space().bounds();
  Fit trial = from, best;
  bool released = false;
  for (int pass = 0; pass < most_passes; ++pass) {
    const auto moving = pass == 0 ? active : felt_coordinates(misfit, trial.u);
    const Groups groups = groups_on(misfit.space(), trial.held, moving, trial.u, fixed);
    Fit next = fit(misfit, trial.u, groups, most_iterations, stop);
    next.held = trial.held;
    if (std::ranges::any_of(next.held, [&](std::size_t b) { return is_broken(bounds[b], next.u); }))
      return Fit{next.u, next.held, infinite, Status::not_finite, 0, infinite};  // what is fixed cannot be on the bound
    if (hold_broken(bounds, next.u, next.held) && next.status != Status::interrupted) {
      trial = next;
      continue;
    }
    if (next.status == Status::interrupted) next.u = put_within(misfit.space(), next.u, next.held);
    const bool better = next.sum_of_squares < best.sum_of_squares - 1e-4;
    if (better || best.u.size() == 0) best = next;
    trial = best;
    if (!better || next.status == Status::interrupted) return best;
    // Off a bound the entries may depend on more: on vs where Fs is no longer Fc.
    const bool once_more = std::exchange(released, release_one(misfit, bounds, trial, fixed));
    if (!released && !once_more) return best;
  }
  best.status = Status::stalled;
  return best;
}

std::vector<Eigen::Index> felt_coordinates(const Misfit& misfit, const Eigen::VectorXd& u) {
  std::vector<Eigen::Index> all(static_cast<std::size_t>(misfit.space().size()));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  Eigen::VectorXd entries;
  Eigen::MatrixXd slopes;
  if (!misfit.at(u, entries, &slopes)) return all;
  const double largest = slopes.colwise().norm().maxCoeff();
  std::erase_if(all, [&](Eigen::Index k) { return !(slopes.col(k).norm() > 1e-8 * largest); });
  return all;
}

}  // namespace limcycle
