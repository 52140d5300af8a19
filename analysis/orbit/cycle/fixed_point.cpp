#include "limcycle/analysis/orbit/cycle/fixed_point.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/orbit/cycle/floquet.hpp"
#include "limcycle/analysis/orbit/settle/two_tolerances.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd left_null_space(const MatrixXd& rows) {
  if (rows.rows() == 0) return MatrixXd(0, 0);
  const auto svd = singular_values(rows);
  const auto rank = (svd.values.array() > 1e-9).count();
  return svd.U.rightCols(rows.rows() - rank);
}

}  // namespace

FixedPoint::FixedPoint(const Loop& loop, ReturnMap map, const ShootingOptions& options)
    : map_(std::move(map)), options_(options), first_(loop.states()), typical_(typical_sizes(loop)) {
  map_.set_extremes(true);
}

Status FixedPoint::warm_up(const LoopState& guess) {
  auto result = map_.approach(guess);
  Status status = result.status;
  state_ = result.state;
  double change = infinite;
  for (int i = 0; i < std::max(options_.warm_maps, 1) && status == Status::converged && change > 1e-6; ++i) {
    result = map(state_);
    status = result.status;
    if (status != Status::converged || options_.warm_maps == 0) continue;
    change = SectionChart(map_.section(), result.largest, typical_).coordinates(result.state.x, state_.x).norm();
    state_ = result.state;
  }
  largest_ = result.largest;
  return status;
}

Status FixedPoint::solve(double rtol, double tolerance, int most_maps) {
  map_.set_rtol(rtol);
  map_.set_trace(true);
  chart_.emplace(map_.section(), largest_, typical_);
  auto image = map(state_);
  if (image.status != Status::converged) return image.status;
  VectorXd r = residual(image);
  bool fresh = false;
  // Without a derivative nothing filters the noise of the integration.
  const auto goal = [&] { return no_derivative_ ? std::max(tolerance, 10.0 * rtol) : tolerance; };
  while (r.norm() > goal()) {
    if (maps_ > std::min(options_.max_maps, most_maps) || map_.steps() > options_.max_steps)
      return Status::max_iterations;
    if (jacobian_.size() == 0) {
      if (const Status status = find_jacobian(rtol, r.size()); status != Status::converged) return status;
      fresh = true;
    }
    if (newton(image, r, fresh)) {
      fresh = no_derivative_;
      continue;
    }
    if (image.status == Status::interrupted) return image.status;
    if (r.norm() < 100.0 * goal()) break;  // the floor of the integration itself
    if (!fresh) {
      jacobian_.resize(0, 0);  // the kept Jacobian is too old
      continue;
    }
    if (stuck_++ > 6) return Status::stalled;  // plain maps as the fallback
    state_ = image.state;
    image = map(state_);
    if (image.status != Status::converged) return image.status;
    r = residual(image);
    jacobian_.resize(0, 0);
    fresh = false;
  }
  residual_ = r.norm();
  time_ = image.time;
  largest_ = image.largest;
  image_ = image.state.x;
  amplitude_ = map_.amplitude(image);
  trace_ = std::move(image.trace);
  return Status::converged;
}

bool FixedPoint::repeats_small_states() const {
  constexpr double part = 1e-6, rounding = 1e-14;
  for (std::size_t i = 0; i < image_.size(); ++i) {
    const double change = std::abs(image_[i] - state_.x[i]);
    if (change > part * std::abs(largest_[i]) && change > rounding * typical_[i]) return false;
  }
  return true;
}

Status FixedPoint::compare(double loose, double& difference) {
  if (map_.options().returns > 1 || no_derivative_ || (!is_linear_at(loose) && linearise(loose) != Status::converged))
    return compare_anew(loose, difference);
  const VectorXd step = newton_step(chart_->coordinates(linear_.state.x, linear_at_.x));
  const VectorXd moved = chart_->scale.cwiseProduct(chart_->basis * step);
  const double time = linear_.time + linear_.time_gradient.dot(moved);
  const double size = map_.amplitude(linear_) + map_.amplitude_gradient(linear_).dot(moved);
  difference = std::max(std::abs(time / time_ - 1.0), std::abs(size / amplitude_ - 1.0));
  return Status::converged;
}

Status FixedPoint::linearise(double rtol) {
  const double kept = map_.options().rtol;
  map_.set_rtol(rtol);
  map_.set_trace(false);
  map_.set_derivative(true);
  linear_at_ = state_;
  linear_rtol_ = rtol;
  linear_ = map(state_);
  map_.set_rtol(kept);
  map_.set_trace(true);
  map_.set_derivative(false);
  if (linear_.status != Status::converged) return linear_.status;
  if (linear_.derivative.size() == 0) return Status::stalled;
  jacobian_ = chart_->restricted(linear_.derivative);
  find_kept();
  return Status::converged;
}

bool FixedPoint::is_linear_at(double rtol) const {
  if (jacobian_.size() == 0 || linear_.status != Status::converged || linear_.derivative.size() == 0) return false;
  return std::abs(linear_rtol_ / rtol - 1.0) < 1e-9 && chart_->coordinates(linear_at_.x, state_.x).norm() < 1e-5;
}

int FixedPoint::remembered() const {
  Eigen::Index unused = 0;
  for (Eigen::Index i = first_; i < std::ssize(state_.x); ++i)
    if (state_.x[static_cast<std::size_t>(i)] == 0.0 && is_kept(i)) ++unused;
  return static_cast<int>(kept_.cols() + turned_ - unused);
}

std::vector<std::complex<double>> FixedPoint::multipliers(double& trivial_error) const {
  auto factors = linear_.factors;
  for (auto& factor : factors) factor = chart_->scaled(factor);
  auto values = product_eigenvalues(factors);
  const auto nearest = [&](double to) {
    return std::ranges::min_element(values, {}, [=](std::complex<double> value) { return std::abs(value - to); });
  };
  for (Eigen::Index k = 0; k < kept_.cols(); ++k) values.erase(nearest(1.0));
  for (Eigen::Index k = 0; k < turned_; ++k) values.erase(nearest(-1.0));
  const auto trivial = nearest(1.0);
  trivial_error = std::max(linear_.flow_defect, std::abs(*trivial - 1.0));
  values.erase(trivial);
  return values;
}

/// A derivative by which to begin. Where a switch is grazed, or a curve of infinite slope is passed, there is none,
/// or the implicit steps that carry it fail: plain maps then, which Broyden's updates improve.
Status FixedPoint::find_jacobian(double rtol, Eigen::Index size) {
  if (!no_derivative_) {
    const Status status = linearise(std::max(loose_tolerance(rtol, loosest_shooting_rtol), 1e-8));
    if (status == Status::converged && linear_.flow_defect <= lost_derivative) return status;
    if (status == Status::interrupted || status == Status::max_iterations) return status;
    no_derivative_ = true;
  }
  jacobian_ = MatrixXd::Zero(size, size);
  kept_.resize(0, 0);
  return Status::converged;
}

/// One damped Newton step from state_ with residual r; moves there and returns true if the residual falls enough: to
/// a third with an old Jacobian, at all with a fresh one (which is worth shorter steps).
bool FixedPoint::newton(ReturnMap::Result& image, VectorXd& r, bool fresh) {
  const VectorXd step = newton_step(r);
  LoopState trial = state_;
  double damping = 1.0;
  const int most_halvings = fresh && !no_derivative_ ? 6 : 1;
  for (int halvings = 0; halvings < most_halvings; ++halvings, damping *= 0.5) {
    trial.x = chart_->lift(state_.x, damping * step);
    const auto next = map(trial);
    if (next.status == Status::interrupted) {
      image.status = next.status;
      return false;
    }
    if (next.status != Status::converged) continue;
    const VectorXd there = chart_->coordinates(next.state.x, trial.x);
    if (there.norm() >= (fresh ? 0.9 : 0.3) * r.norm()) continue;
    improve_jacobian(damping * step, there - r);
    state_ = trial;
    image = next;
    r = there;
    return true;
  }
  return false;
}

/// Broyden's update (1965): the least change with which the Jacobian explains the last step.
void FixedPoint::improve_jacobian(const VectorXd& step, const VectorXd& change) {
  const VectorXd unexplained = change - (jacobian_ * step - step);
  if (step.squaredNorm() > 0.0) jacobian_ += unexplained * step.transpose() / step.squaredNorm();
}

/// The derivative less `multiplier` times 1 and, below it, the combinations that are kept, which stay unchanged: in the
/// chart the element states come last, as in the state.
MatrixXd FixedPoint::away_from(double multiplier) const {
  const Eigen::Index n = jacobian_.rows();
  MatrixXd matrix = MatrixXd::Zero(n + kept_.cols(), n);
  matrix.topRows(n) = jacobian_ - multiplier * MatrixXd::Identity(n, n);
  matrix.bottomRightCorner(kept_.cols(), kept_.rows()) = kept_.transpose();
  return matrix;
}

VectorXd FixedPoint::newton_step(const VectorXd& r) const {
  const MatrixXd matrix = away_from(1.0);
  VectorXd right = VectorXd::Zero(matrix.rows());
  right.head(r.size()) = r;
  return -least_squares(matrix, right, 1e-7);
}

/// compare() by solving again at the loose tolerance.
Status FixedPoint::compare_anew(double loose, double& difference) {
  const auto kept = std::tuple(state_, time_, amplitude_, residual_, trace_);
  const Status status = solve(loose, std::max(options_.tolerance, 0.1 * loose));
  const double time = time_, size = amplitude_;
  std::tie(state_, time_, amplitude_, residual_, trace_) = kept;
  difference = std::max(std::abs(time / time_ - 1.0), std::abs(size / amplitude_ - 1.0));
  return status;
}

VectorXd FixedPoint::neutral() const {
  constexpr double close = 1e-6;
  VectorXd found;
  double least = close;
  for (const double multiplier : {1.0, -1.0}) {
    if (multiplier < 0.0 && !map_.half()) continue;
    const auto svd = singular_values(MatrixXd(away_from(multiplier).transpose()));
    if (svd.values.size() == 0 || !(svd.values(svd.values.size() - 1) < least)) continue;
    least = svd.values(svd.values.size() - 1);
    found = chart_->scale.cwiseProduct(chart_->basis * svd.U.col(svd.values.size() - 1));
  }
  return found;
}

/// Finds the combinations of element states that the map keeps for any state, and for a half map those that it
/// reverses (a whole period keeps them): left eigenvectors of its derivative on element states alone.
void FixedPoint::find_kept() {
  const MatrixXd all = chart_->scaled(linear_.derivative);
  const Eigen::Index count = all.rows() - first_;
  MatrixXd rows = all.bottomRows(count);
  rows.rightCols(count) -= MatrixXd::Identity(count, count);
  kept_ = left_null_space(rows);
  rows.rightCols(count) += 2.0 * MatrixXd::Identity(count, count);
  turned_ = map_.half() ? left_null_space(rows).cols() : 0;
}

}  // namespace limcycle
