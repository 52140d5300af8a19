#include "limcycle/analysis/orbit/shooting.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/measure.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd as_vector(const State& x) { return Eigen::Map<const VectorXd>(x.data(), std::ssize(x)); }

/// Coordinates on the section: x = origin + scale * (basis u), basis orthonormal and tangent to the section.
struct Chart {
  VectorXd scale;
  MatrixXd basis;

  Chart(const Section& section, const State& largest, const State& typical) : scale(as_vector(largest)) {
    for (Index i = 0; i < scale.size(); ++i) scale(i) = std::max(scale(i), 1e-6 * typical[static_cast<std::size_t>(i)]);
    VectorXd normal = VectorXd::Zero(scale.size());
    normal.head(section.C.size()) = section.C.transpose();
    normal.array() *= scale.array();
    const MatrixXd q = normal.householderQr().householderQ();
    basis = q.rightCols(scale.size() - 1);
  }
  State lift(const State& origin, const VectorXd& u) const {
    State x = origin;
    const VectorXd step = scale.cwiseProduct(basis * u);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += step(static_cast<Index>(i));
    return x;
  }
  VectorXd coordinates(const State& x, const State& origin) const {
    return basis.transpose() * (as_vector(x) - as_vector(origin)).cwiseQuotient(scale);
  }
};

/// Newton on the return map.
class Shooter {
 public:
  Shooter(const Loop& loop, ReturnMap map, const ShootingOptions& options)
      : map_(std::move(map)), options_(options), typical_(typical_sizes(loop)) {}

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
  Status solve() {
    chart_.emplace(map_.section(), largest_, typical_);
    auto image = map(state_);
    if (image.status != Status::converged) return image.status;
    VectorXd r = residual(image);
    bool fresh = false;
    while (r.norm() > options_.tolerance) {
      if (maps_ > options_.max_maps) return Status::max_iterations;
      if (jacobian_.size() == 0) {
        if (const Status status = difference(false); status != Status::converged) return status;
        fresh = true;
      }
      if (newton(image, r, fresh)) {
        fresh = false;
        continue;
      }
      if (image.status == Status::interrupted) return image.status;
      if (r.norm() < 100.0 * options_.tolerance) break;  // the floor of the integration itself
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

  /// One damped Newton step from state_ with residual r; moves there and returns true if the residual falls enough: to
  /// a third with an old Jacobian, at all with a fresh one (which is worth shorter steps).
  bool newton(ReturnMap::Result& image, VectorXd& r, bool fresh) {
    const VectorXd step = -(jacobian_ - MatrixXd::Identity(r.size(), r.size())).partialPivLu().solve(r);
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

  /// Jacobian of the map in chart coordinates, by one-sided or central differences.
  Status difference(bool central) {
    const Index m = chart_->basis.cols();
    jacobian_.resize(m, m);
    ReturnMap::Result base;
    if (!central) {
      base = map(state_);
      if (base.status != Status::converged) return base.status;
    }
    for (Index k = 0; k < m; ++k) {
      const VectorXd unit = VectorXd::Unit(m, k);
      LoopState moved = state_;
      moved.x = chart_->lift(state_.x, delta_ * unit);
      const auto plus = map(moved);
      if (plus.status != Status::converged) return plus.status;
      if (central) {
        moved.x = chart_->lift(state_.x, -delta_ * unit);
        base = map(moved);
        if (base.status != Status::converged) return base.status;
      }
      jacobian_.col(k) = chart_->coordinates(plus.state.x, base.state.x) / (central ? 2.0 * delta_ : delta_);
    }
    return Status::converged;
  }

  void set_rtol(double rtol) { map_.set_rtol(rtol); }
  void set_delta(double delta) { delta_ = delta; }
  const LoopState& state() const { return state_; }
  double period() const { return map_.half() ? 2.0 * time_ : time_; }
  double residual_size() const { return residual_; }
  const MatrixXd& jacobian() const { return jacobian_; }
  bool half() const { return map_.half(); }
  int maps() const { return maps_; }

 private:
  ReturnMap::Result map(const LoopState& from) {
    ++maps_;
    return map_(from);
  }
  VectorXd residual(const ReturnMap::Result& image) const { return chart_->coordinates(image.state.x, state_.x); }

  ReturnMap map_;
  const ShootingOptions& options_;
  State typical_, largest_;
  std::optional<Chart> chart_;
  LoopState state_;
  MatrixXd jacobian_;
  double residual_ = infinite, time_ = 0.0, delta_ = 1e-6;
  int maps_ = 0, stuck_ = 0;
};

/// Multipliers of the full period, largest first.
std::vector<std::complex<double>> multipliers(const MatrixXd& jacobian, bool half) {
  if (jacobian.size() == 0) return {};
  const Eigen::VectorXcd values = jacobian.eigenvalues();
  std::vector<std::complex<double>> result(values.begin(), values.end());
  for (auto& value : result)
    if (half) value *= value;
  std::ranges::sort(result, [](auto a, auto b) {
    return std::abs(a) != std::abs(b) ? std::abs(a) > std::abs(b) : a.imag() > b.imag();
  });
  return result;
}

ShootingResult failed(Status status, const Shooter& shooter, std::string why) {
  ShootingResult result;
  result.status = status;
  result.maps = shooter.maps();
  result.why = std::move(why);
  return result;
}

/// Fills the cycle from the solved map; false if the recording fails.
bool describe(const Loop& loop, const Shooter& shooter, double rtol, Cycle& cycle) {
  cycle.period = shooter.period();
  cycle.residual = shooter.residual_size();
  cycle.half_wave_symmetric = shooter.half();
  cycle.start = shooter.state();
  cycle.trace = {};
  if (record(loop, cycle.start, cycle.period, rtol, 1000, cycle.trace) != Status::converged) return false;
  measure(loop, cycle);
  return true;
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

ShootingResult shoot(const Loop& loop, const LoopState& guess, const Section& section, bool half,
                     const ShootingOptions& options) {
  const double loose = 30.0 * options.rtol;
  std::optional<Reflection> reflection;
  if (half) reflection = symmetry(loop);
  Shooter shooter(loop, {loop, section, reflection, {loose, options.max_steps_per_map, options.stop}}, options);
  Status status = shooter.warm_up(guess);
  if (status != Status::converged) return failed(status, shooter, "the motion did not return to the section");
  status = shooter.solve();
  if (status != Status::converged) return failed(status, shooter, "no fixed point of the return map was reached");
  Cycle rough;
  if (!describe(loop, shooter, loose, rough))
    return failed(Status::stalled, shooter, "the cycle could not be followed");

  shooter.set_rtol(options.rtol);
  status = shooter.solve();
  if (status != Status::converged) return failed(status, shooter, "the fixed point was lost at the tight tolerance");
  ShootingResult result;
  if (!describe(loop, shooter, options.rtol, result.cycle))
    return failed(Status::stalled, shooter, "the cycle could not be followed");

  // Two difference steps: what they disagree by is the error of the multipliers.
  shooter.set_delta(1e-5);
  status = shooter.difference(true);
  const MatrixXd coarse = shooter.jacobian();
  shooter.set_delta(1e-6);
  if (status == Status::converged) status = shooter.difference(true);
  Cycle& cycle = result.cycle;
  cycle.method = "shooting";
  cycle.error = std::max({std::abs(cycle.period / rough.period - 1.0),
                          std::abs(cycle.amplitude / rough.amplitude - 1.0), cycle.residual, 10.0 * options.rtol});
  if (status == Status::converged) {
    cycle.multipliers = multipliers(shooter.jacobian(), shooter.half());
    result.multiplier_error = (coarse - shooter.jacobian()).norm() + 1e-9;
    const double largest = cycle.multipliers.empty() ? 0.0 : std::abs(cycle.multipliers.front());
    if (std::abs(largest - 1.0) > 2.0 * result.multiplier_error) cycle.stable = largest < 1.0;
  }
  result.status = Status::converged;
  result.maps = shooter.maps();
  return result;
}

}  // namespace limcycle
