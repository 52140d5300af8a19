#include "limcycle/analysis/orbit/cycle/shooting.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/cycle/floquet.hpp"
#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/analysis/orbit/cycle/section_chart.hpp"
#include "limcycle/analysis/orbit/settle/two_tolerances.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double loosest = 1e-6;  ///< beyond, a cycle with stick may be lost
constexpr double tightest = 1e-13;
constexpr double lost = 0.5;  ///< a derivative that fails by more to carry the motion along itself tells nothing

/// Newton on the return map.
class Shooter {
 public:
  Shooter(const Loop& loop, ReturnMap map, const ShootingOptions& options)
      : map_(std::move(map)), options_(options), first_(loop.states()), typical_(typical_sizes(loop)) {
    map_.set_extremes(true);
  }

  Status warm_up(const LoopState& guess) {
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

  /// Brings the residual below the tolerance; on return state_ is the best point and residual_ its residual.
  Status solve(double rtol, double tolerance) {
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
      if (maps_ > options_.max_maps || map_.steps() > options_.max_steps) return Status::max_iterations;
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
    amplitude_ = map_.amplitude(image);
    trace_ = std::move(image.trace);
    return Status::converged;
  }

  /// Relative difference in period and amplitude between the solution and that of a looser integration, which is so
  /// close that the derivative of the map leads to it.
  Status compare(double loose, double& difference) {
    if (map_.options().returns > 1 || no_derivative_ || (!is_linear_at(loose) && linearise(loose) != Status::converged))
      return compare_anew(loose, difference);
    const VectorXd step = newton_step(chart_->coordinates(linear_.state.x, linear_at_.x));
    const VectorXd moved = chart_->scale.cwiseProduct(chart_->basis * step);
    const double time = linear_.time + linear_.time_gradient.dot(moved);
    const double size = map_.amplitude(linear_) + map_.amplitude_gradient(linear_).dot(moved);
    difference = std::max(std::abs(time / time_ - 1.0), std::abs(size / amplitude_ - 1.0));
    return Status::converged;
  }

  /// Derivative of the map at state_, integrated at its own tolerance. Status stalled: a switch is grazed there.
  Status linearise(double rtol) {
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

  /// True if the derivative is already known, at this tolerance and close enough. (A Jacobian that was too old is
  /// discarded, and at a grazed switch there is none.)
  bool is_linear_at(double rtol) const {
    if (jacobian_.size() == 0 || linear_.status != Status::converged || linear_.derivative.size() == 0) return false;
    return std::abs(linear_rtol_ / rtol - 1.0) < 1e-9 && chart_->coordinates(linear_at_.x, state_.x).norm() < 1e-5;
  }

  /// See Cycle::remembered; states that are zero and stay so remember nothing.
  int remembered() const {
    Eigen::Index unused = 0;
    for (Eigen::Index i = first_; i < std::ssize(state_.x); ++i)
      if (state_.x[static_cast<std::size_t>(i)] == 0.0 && is_kept(i)) ++unused;
    return static_cast<int>(kept_.cols() + turned_ - unused);
  }

  /// Multipliers of the (half) map, from the factors of its derivative, without those of kept combinations (see
  /// find_kept). The trivial one is removed; its deviation from 1 gives their error.
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
  double amplitude() const { return amplitude_; }
  const Trace& trace() const { return trace_; }
  double residual_size() const { return residual_; }
  const std::optional<Reflection>& reflection() const { return map_.reflection(); }
  int maps() const { return maps_; }
  long steps() const { return map_.steps(); }

 private:
  /// A derivative by which to begin. Where a switch is grazed, or a curve of infinite slope is passed, there is none,
  /// or the implicit steps that carry it fail: plain maps then, which Broyden's updates improve.
  Status find_jacobian(double rtol, Eigen::Index size) {
    if (!no_derivative_) {
      const Status status = linearise(std::max(loose_tolerance(rtol, loosest), 1e-8));
      if (status == Status::converged && linear_.flow_defect <= lost) return status;
      if (status == Status::interrupted || status == Status::max_iterations) return status;
      no_derivative_ = true;
    }
    jacobian_ = MatrixXd::Zero(size, size);
    kept_.resize(0, 0);
    return Status::converged;
  }

  /// One damped Newton step from state_ with residual r; moves there and returns true if the residual falls enough: to
  /// a third with an old Jacobian, at all with a fresh one (which is worth shorter steps).
  bool newton(ReturnMap::Result& image, VectorXd& r, bool fresh) {
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
  void improve_jacobian(const VectorXd& step, const VectorXd& change) {
    const VectorXd unexplained = change - (jacobian_ * step - step);
    if (step.squaredNorm() > 0.0) jacobian_ += unexplained * step.transpose() / step.squaredNorm();
  }

  VectorXd newton_step(const VectorXd& r) const {
    // Kept combinations stay unchanged. In the chart the element states come last, as in the state.
    MatrixXd matrix = MatrixXd::Zero(r.size() + kept_.cols(), r.size());
    matrix.topRows(r.size()) = jacobian_ - MatrixXd::Identity(r.size(), r.size());
    matrix.bottomRightCorner(kept_.cols(), kept_.rows()) = kept_.transpose();
    VectorXd right = VectorXd::Zero(matrix.rows());
    right.head(r.size()) = r;
    return -least_squares(matrix, right, 1e-7);
  }

  /// compare() by solving again at the loose tolerance.
  Status compare_anew(double loose, double& difference) {
    const auto kept = std::tuple(state_, time_, amplitude_, residual_, trace_);
    const Status status = solve(loose, std::max(options_.tolerance, 0.1 * loose));
    const double time = time_, size = amplitude_;
    std::tie(state_, time_, amplitude_, residual_, trace_) = kept;
    difference = std::max(std::abs(time / time_ - 1.0), std::abs(size / amplitude_ - 1.0));
    return status;
  }

  /// Finds the combinations of element states that the map keeps for any state, and for a half map those that it
  /// reverses (a whole period keeps them): left eigenvectors of its derivative on element states alone.
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
    const auto svd = singular_values(rows);
    const auto rank = (svd.values.array() > 1e-9).count();
    return svd.U.rightCols(rows.rows() - rank);
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
  LoopState linear_at_;
  double linear_rtol_ = 0.0;
  Trace trace_;
  MatrixXd jacobian_;
  double residual_ = infinite, time_ = 0.0, amplitude_ = 0.0;
  int maps_ = 0, stuck_ = 0;
  bool no_derivative_ = false;  ///< see find_jacobian
};

ShootingResult failed(Status status, const Shooter& shooter, std::string why) {
  ShootingResult result;
  result.status = status;
  result.maps = shooter.maps();
  result.steps = shooter.steps();
  result.why = std::move(why);
  return result;
}

/// Fills the cycle from the solved map; recorded anew if the map has taken fewer steps. False if that fails.
bool describe(const Loop& loop, const Shooter& shooter, double rtol, int resolution, Cycle& cycle) {
  cycle.period = shooter.period();
  cycle.residual = shooter.residual_size();
  cycle.half_wave_symmetric = shooter.reflection().has_value();
  cycle.start = shooter.state();
  const int parts = cycle.half_wave_symmetric ? 2 : 1;
  cycle.trace = shooter.trace();
  const double duration = cycle.period / parts;
  if (parts * std::ssize(cycle.trace.t) < resolution) {
    cycle.trace = {};
    if (record(loop, cycle.start, duration, rtol, resolution / parts, cycle.trace) != Status::converged) return false;
  }
  if (cycle.half_wave_symmetric) append_reflected(loop, shooter.reflection()->centre, cycle.trace);
  measure(loop, cycle);
  cycle.amplitude = shooter.amplitude();
  return true;
}

/// Multipliers at two tolerances, whose disagreement is their error, and the verdict they allow.
void judge(Shooter& shooter, ShootingResult& result, bool exact, double rtol) {
  Cycle& cycle = result.cycle;
  std::vector<std::complex<double>> rough;
  double trivial = 0.0;
  if (!exact) {
    if (!shooter.is_linear_at(10.0 * rtol) && shooter.linearise(10.0 * rtol) != Status::converged) return;
    rough = shooter.multipliers(trivial);
  }
  if (shooter.linearise(rtol) != Status::converged) return;
  cycle.multipliers = shooter.multipliers(result.trivial_error);
  cycle.remembered = shooter.remembered();
  result.multiplier_error = 1e-12 + result.trivial_error;
  if (!exact && rough.size() != cycle.multipliers.size()) return;  // the two disagree on the kept combinations
  for (std::size_t i = 0; i < rough.size(); ++i)
    result.multiplier_error = std::max(result.multiplier_error, std::abs(rough[i] - cycle.multipliers[i]));
  const double of_map = cycle.multipliers.empty() ? 0.0 : std::abs(cycle.multipliers.front());
  cycle.multiplier_error = (shooter.reflection() ? 2.0 * of_map : 1.0) * result.multiplier_error;
  if (shooter.reflection())
    for (auto& value : cycle.multipliers) value *= value;
  const double largest = cycle.multipliers.empty() ? 0.0 : std::abs(cycle.multipliers.front());
  if (result.trivial_error < 0.1 && std::abs(largest - 1.0) > 4.0 * result.multiplier_error)
    cycle.stable = largest < 1.0;
}

/// Solves at rtol and, if an accuracy is wanted, with ever tighter tolerances until the estimate reaches it. On return
/// `rtol` is the last one, and `error` the estimate.
Status refine(Shooter& shooter, const ShootingOptions& options, double& rtol, double& error) {
  double tolerance = options.tolerance;
  while (true) {
    if (const Status status = shooter.solve(rtol, tolerance); status != Status::converged) return status;
    const double loose = loose_tolerance(rtol, loosest);
    double difference = 0.0;
    if (const Status status = shooter.compare(loose, difference); status != Status::converged) return status;
    error = std::max({stated_share(rtol, loose) * difference, shooter.residual_size(), rtol});
    if (options.accuracy == 0.0 || error <= options.accuracy || rtol <= tightest) return Status::converged;
    const double by = tightening(options.accuracy, error);
    rtol = std::max(by * rtol, tightest);
    tolerance *= by;
  }
}

/// True if y swings by more than roundings. A body that sticks returns to the section for any length of time.
bool moves(const Loop& loop, const Cycle& cycle) {
  const State typical = typical_sizes(loop);
  double size = 0.0;
  for (Eigen::Index i = 0; i < loop.C_y.size(); ++i)
    size = std::max(size, std::abs(loop.C_y(i)) * typical[static_cast<std::size_t>(i)]);
  for (const double y : cycle.trace.y) size = std::max(size, std::abs(y));
  return cycle.amplitude > 1e-13 * size;
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
  const double coarse = std::clamp(loose_tolerance(options.rtol, loosest), 1e-7, loosest);
  const bool exact = choose_stepper(loop, options.rtol) == StepperKind::exact;
  std::optional<Reflection> reflection;
  if (half) reflection = symmetry(loop);
  ReturnMap::Options map{coarse, options.max_steps_per_map, options.stop};
  map.longest = options.longest_map;
  map.returns = options.returns;
  Shooter shooter(loop, {loop, section, reflection, map}, options);
  Status status = shooter.warm_up(guess);
  if (status != Status::converged) return failed(status, shooter, "the motion did not return to the section");
  if (!exact && coarse > options.rtol) status = shooter.solve(coarse, 30.0 * coarse);
  if (status != Status::converged) return failed(status, shooter, "no fixed point of the return map was reached");

  ShootingResult result;
  Cycle& cycle = result.cycle;
  double rtol = options.rtol;
  status = exact ? shooter.solve(rtol, 1e-13) : refine(shooter, options, rtol, cycle.error);
  if (exact) cycle.error = std::max(shooter.residual_size(), 1e-13);
  if (status != Status::converged) return failed(status, shooter, "the fixed point was lost at the tight tolerance");
  if (!describe(loop, shooter, rtol, options.resolution, cycle))
    return failed(Status::stalled, shooter, "the cycle could not be followed");
  if (!moves(loop, cycle)) return failed(Status::no_cycle, shooter, "the fixed point is an equilibrium, not a cycle");
  cycle.method = exact ? "exact" : "shooting";
  if (options.derivative_rtol > 0.0) {
    judge(shooter, result, exact, options.derivative_rtol);
    // A motion through a thin layer (bristles, a steep Stribeck curve) is followed better than its derivative.
    // Where that layer has an infinite slope no tolerance helps.
    constexpr double tight = 1e-10, tighter = 1e-12, rough = 2e-3;
    const auto is_rough = [&] { return !exact && result.multiplier_error > rough; };
    if (!exact && options.derivative_rtol > tight && (!cycle.stable || is_rough()))
      judge(shooter, result, exact, tight);
    if (is_rough() && !has_infinite_slope(loop)) judge(shooter, result, exact, tighter);
    if (result.trivial_error > lost) {
      cycle.multipliers.clear();
      cycle.multiplier_error = std::max(cycle.multiplier_error, result.trivial_error);
    }
  }
  result.status = Status::converged;
  result.maps = shooter.maps();
  result.steps = shooter.steps();
  return result;
}

}  // namespace limcycle
