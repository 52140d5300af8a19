#include "limcycle/analysis/orbit/shooting.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/floquet.hpp"
#include "limcycle/analysis/orbit/measure.hpp"
#include "limcycle/analysis/orbit/section_chart.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Newton on the return map.
class Shooter {
 public:
  Shooter(const Loop& loop, ReturnMap map, const ShootingOptions& options)
      : map_(std::move(map)), options_(options), first_(loop.states()), typical_(typical_sizes(loop)) {}

  Status warm_up(const LoopState& guess) {
    auto result = map_.approach(guess);
    Status status = result.status;
    state_ = result.state;
    for (int i = 0; i < std::max(options_.warm_maps, 1) && status == Status::converged; ++i) {
      result = map(state_);
      status = result.status;
      if (status == Status::converged && options_.warm_maps > 0) state_ = result.state;
    }
    largest_ = result.largest;
    return status;
  }

  /// Brings the residual below the tolerance; on return state_ is the best point and residual_ its residual.
  Status solve(double rtol, double tolerance) {
    map_.set_rtol(rtol);
    chart_.emplace(map_.section(), largest_, typical_);
    auto image = map(state_);
    if (image.status != Status::converged) return image.status;
    VectorXd r = residual(image);
    bool fresh = false;
    while (r.norm() > tolerance) {
      if (maps_ > options_.max_maps) return Status::max_iterations;
      if (jacobian_.size() == 0) {
        if (const Status status = linearise(std::max(rtol, 1e-8)); status != Status::converged) return status;
        fresh = true;
      }
      if (newton(image, r, fresh)) {
        fresh = false;
        continue;
      }
      if (image.status == Status::interrupted) return image.status;
      if (r.norm() < 100.0 * tolerance) break;  // the floor of the integration itself
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
    return Status::converged;
  }

  /// Derivative of the map at state_, integrated at its own tolerance. Status stalled: a switch is grazed there.
  Status linearise(double rtol) {
    const double kept = map_.options().rtol;
    map_.set_rtol(rtol);
    map_.set_derivative(true);
    linear_ = map(state_);
    map_.set_rtol(kept);
    map_.set_derivative(false);
    if (linear_.status != Status::converged) return linear_.status;
    if (linear_.derivative.size() == 0) return Status::stalled;
    jacobian_ = chart_->restricted(linear_.derivative);
    find_kept();
    return Status::converged;
  }

  /// See Cycle::remembered; states that are zero and stay so remember nothing.
  int remembered() const {
    Eigen::Index unused = 0;
    for (Eigen::Index i = first_; i < std::ssize(state_.x); ++i)
      if (state_.x[static_cast<std::size_t>(i)] == 0.0 && is_kept(i)) ++unused;
    return static_cast<int>(kept_.cols() + turned_ - unused);
  }

  /// Multipliers of the (half) map, from the factors of its derivative, without those of what is kept; the trivial one,
  /// taken out, tells their error.
  std::vector<std::complex<double>> multipliers(double& trivial_error) const {
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

  const LoopState& state() const { return state_; }
  double period() const { return map_.half() ? 2.0 * time_ : time_; }
  double residual_size() const { return residual_; }
  bool half() const { return map_.half(); }
  int maps() const { return maps_; }

 private:
  /// One damped Newton step from state_ with residual r; moves there and returns true if the residual falls enough: to
  /// a third with an old Jacobian, at all with a fresh one (which is worth shorter steps).
  bool newton(ReturnMap::Result& image, VectorXd& r, bool fresh) {
    // What is kept stays as it is. In the chart the element states come last, as in the state.
    MatrixXd matrix = MatrixXd::Zero(r.size() + kept_.cols(), r.size());
    matrix.topRows(r.size()) = jacobian_ - MatrixXd::Identity(r.size(), r.size());
    matrix.bottomRightCorner(kept_.cols(), kept_.rows()) = kept_.transpose();
    VectorXd right = VectorXd::Zero(matrix.rows());
    right.head(r.size()) = r;
    const VectorXd step = -least_squares(matrix, right, 1e-7);
    LoopState trial = state_;
    double damping = 1.0;
    for (int halvings = 0; halvings < (fresh ? 6 : 1); ++halvings, damping *= 0.5) {
      trial.x = chart_->lift(state_.x, damping * step);
      const auto next = map(trial);
      if (next.status == Status::interrupted) {
        image.status = next.status;
        return false;
      }
      if (next.status != Status::converged) continue;
      const VectorXd there = chart_->coordinates(next.state.x, trial.x);
      if (there.norm() >= (fresh ? 0.9 : 0.3) * r.norm()) continue;
      state_ = trial;
      image = next;
      r = there;
      return true;
    }
    return false;
  }

  /// Finds the combinations of element states that the map keeps, whatever the state is, and with a half map those that
  /// it turns round (a whole period keeps them): left eigenvectors of its derivative on element states alone.
  void find_kept() {
    const MatrixXd all = chart_->scaled(linear_.derivative);
    const Eigen::Index count = all.rows() - first_;
    MatrixXd rows = all.bottomRows(count);
    rows.rightCols(count) -= MatrixXd::Identity(count, count);
    kept_ = left_null_space(rows);
    rows.rightCols(count) += 2.0 * MatrixXd::Identity(count, count);
    turned_ = map_.half() ? left_null_space(rows).cols() : 0;
  }
  static MatrixXd left_null_space(const MatrixXd& rows) {
    if (rows.rows() == 0) return MatrixXd(0, 0);
    const Eigen::JacobiSVD<MatrixXd> svd(rows, Eigen::ComputeFullU);
    const auto rank = (svd.singularValues().array() > 1e-9).count();
    return svd.matrixU().rightCols(rows.rows() - rank);
  }
  bool is_kept(Eigen::Index state) const { return kept_.rows() > 0 && kept_.row(state - first_).norm() > 1.0 - 1e-9; }

  ReturnMap::Result map(const LoopState& from) {
    ++maps_;
    return map_(from);
  }
  VectorXd residual(const ReturnMap::Result& image) const { return chart_->coordinates(image.state.x, state_.x); }

  ReturnMap map_;
  const ShootingOptions& options_;
  Eigen::Index first_;  ///< index of the first element state
  MatrixXd kept_;       ///< see find_kept: by columns, orthonormal, in units of the chart
  Eigen::Index turned_ = 0;
  State typical_, largest_;
  std::optional<SectionChart> chart_;
  LoopState state_;
  ReturnMap::Result linear_;
  MatrixXd jacobian_;
  double residual_ = infinite, time_ = 0.0;
  int maps_ = 0, stuck_ = 0;
};

ShootingResult failed(Status status, const Shooter& shooter, std::string why) {
  ShootingResult result;
  result.status = status;
  result.maps = shooter.maps();
  result.why = std::move(why);
  return result;
}

/// Fills the cycle from the solved map; false if the recording fails. Two resolutions tell the error of the extremes.
bool describe(const Loop& loop, const Shooter& shooter, double rtol, int resolution, Cycle& cycle) {
  cycle.period = shooter.period();
  cycle.residual = shooter.residual_size();
  cycle.half_wave_symmetric = shooter.half();
  cycle.start = shooter.state();
  cycle.trace = {};
  if (record(loop, cycle.start, cycle.period, rtol, resolution, cycle.trace) != Status::converged) return false;
  measure(loop, cycle);
  return true;
}

/// Multipliers at two tolerances, whose disagreement is their error, and the verdict they allow.
void judge(Shooter& shooter, ShootingResult& result, bool exact, double rtol) {
  if (!(rtol > 0.0)) return;
  Cycle& cycle = result.cycle;
  std::vector<std::complex<double>> rough;
  double trivial = 0.0;
  if (!exact) {
    if (shooter.linearise(10.0 * rtol) != Status::converged) return;
    rough = shooter.multipliers(trivial);
  }
  if (shooter.linearise(rtol) != Status::converged) return;
  cycle.multipliers = shooter.multipliers(result.trivial_error);
  cycle.remembered = shooter.remembered();
  result.multiplier_error = 1e-12 + result.trivial_error;
  if (!exact && rough.size() != cycle.multipliers.size()) return;  // the two disagree on what is kept
  for (std::size_t i = 0; i < rough.size(); ++i)
    result.multiplier_error = std::max(result.multiplier_error, std::abs(rough[i] - cycle.multipliers[i]));
  if (shooter.half())
    for (auto& value : cycle.multipliers) value *= value;
  const double largest = cycle.multipliers.empty() ? 0.0 : std::abs(cycle.multipliers.front());
  if (result.trivial_error < 0.1 && std::abs(largest - 1.0) > 4.0 * result.multiplier_error)
    cycle.stable = largest < 1.0;
}

}  // namespace

Section choose_section(const Loop& loop, const Trace& trace) {
  const auto [low, high] = extremes(trace);
  Section section{loop.C_y, 0.5 * (low + high) + 0.135 * (high - low), 1};
  double fastest = 0.0;
  for (std::size_t i = 0; i + 1 < trace.y.size(); ++i) {
    if ((trace.y[i] < section.level) == (trace.y[i + 1] < section.level)) continue;
    const double rate = 0.5 * (trace.rate[i] + trace.rate[i + 1]);
    if (std::abs(rate) > std::abs(fastest)) fastest = rate;
  }
  section.direction = fastest < 0.0 ? -1 : 1;
  return section;
}

int returns_of(const Section& section, const Trace& trace) {
  int count = 0;
  for (std::size_t i = 0; i + 1 < trace.y.size(); ++i) {
    const bool before = trace.y[i] < section.level, after = trace.y[i + 1] < section.level;
    if (before != after && before == (section.direction > 0)) ++count;
  }
  return std::max(count, 1);
}

ShootingResult shoot(const Loop& loop, const LoopState& guess, const Section& section, bool half,
                     const ShootingOptions& options) {
  const double loose = 30.0 * options.rtol, coarse = std::max(1e-7, loose);
  const bool exact = choose_stepper(loop, options.rtol) == StepperKind::exact;
  std::optional<Reflection> reflection;
  if (half) reflection = symmetry(loop);
  Shooter shooter(loop,
                  {loop,
                   section,
                   reflection,
                   {coarse, options.max_steps_per_map, options.stop, false, options.longest_map, options.returns}},
                  options);
  Status status = shooter.warm_up(guess);
  if (status != Status::converged) return failed(status, shooter, "the motion did not return to the section");
  if (!exact && coarse > loose) status = shooter.solve(coarse, 30.0 * coarse);
  const double tolerance = exact ? 1e-13 : options.tolerance;
  if (status == Status::converged) status = shooter.solve(loose, tolerance);
  if (status != Status::converged) return failed(status, shooter, "no fixed point of the return map was reached");
  Cycle rough;
  if (!describe(loop, shooter, loose, options.resolution / 2, rough))
    return failed(Status::stalled, shooter, "the cycle could not be followed");

  status = shooter.solve(options.rtol, tolerance);
  if (status != Status::converged) return failed(status, shooter, "the fixed point was lost at the tight tolerance");
  ShootingResult result;
  Cycle& cycle = result.cycle;
  if (!describe(loop, shooter, options.rtol, options.resolution, cycle))
    return failed(Status::stalled, shooter, "the cycle could not be followed");
  cycle.method = exact ? "exact" : "shooting";
  const double floor = exact ? 1e-13 : 10.0 * options.rtol;
  cycle.error = std::max({std::abs(cycle.period / rough.period - 1.0),
                          std::abs(cycle.amplitude / rough.amplitude - 1.0), cycle.residual, floor});
  judge(shooter, result, exact, options.derivative_rtol);
  result.status = Status::converged;
  result.maps = shooter.maps();
  return result;
}

}  // namespace limcycle
