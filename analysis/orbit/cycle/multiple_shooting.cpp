#include "limcycle/analysis/orbit/cycle/multiple_shooting.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Eigen::Map<const VectorXd> as_vector(const State& x) { return {x.data(), std::ssize(x)}; }

/// The flow over one segment, with its derivatives over the start and the time.
struct Segment {
  Status status = Status::converged;
  LoopState end;
  MatrixXd derivative;
  VectorXd rate;
};

class MultipleShooter {
 public:
  MultipleShooter(const Loop& loop, const OrbitGuess& guess, const ShootingOptions& options)
      : loop_(loop),
        options_(options),
        field_(loop),
        reflection_(guess.half ? symmetry(loop) : std::nullopt),
        nodes_(guess.nodes),
        span_(reflection_ ? 0.5 * guess.period : guess.period) {
    const State typical = typical_sizes(loop);
    scale_ = 1e-6 * as_vector(typical);
    for (const auto& node : nodes_) scale_ = scale_.cwiseMax(as_vector(node.x).cwiseAbs());
  }

  Status solve() {
    Status status = evaluate(nodes_, span_);
    for (int i = 0; i < 40 && status == Status::converged; ++i) {
      if (residual_.norm() < 1e-8) return Status::converged;
      if (!step()) return residual_.norm() < 1e-5 ? Status::converged : Status::stalled;
    }
    return status == Status::converged ? Status::max_iterations : status;
  }

  const LoopState& start() const { return nodes_.front(); }
  double period() const { return reflection_ ? 2.0 * span_ : span_; }
  int maps() const { return maps_; }
  long steps() const { return steps_; }

 private:
  Segment flow(const LoopState& from, double duration) {
    Segment segment;
    field_.modes() = from.modes;
    const bool exact = choose_stepper(loop_, rtol) == StepperKind::exact;
    March march(field_, exact ? StepperKind::exact : StepperKind::rodas5p, loop_weights(loop_, rtol));
    march.track();
    march.begin(from.x, 0.0);
    segment.derivative = MatrixXd::Identity(std::ssize(from.x), std::ssize(from.x));
    while (march.t() < duration && segment.status == Status::converged) {
      if (options_.stop && options_.stop()) segment.status = Status::interrupted;
      if (march.steps() > options_.max_steps_per_map) segment.status = Status::max_iterations;
      if (segment.status == Status::converged) segment.status = march.step(duration);
      if (segment.status != Status::converged) break;
      if (march.last().transition.size() == 0) segment.status = Status::stalled;  // a switch is grazed
      if (segment.status == Status::converged)
        segment.derivative = (march.last().transition * segment.derivative).eval();
    }
    steps_ += march.steps();
    segment.end = {march.x(), field_.modes()};
    State rate;
    if (segment.status == Status::converged) field_.rate(march.x(), rate, 0.0);
    segment.rate = as_vector(rate);
    return segment;
  }

  /// Residuals and segments of these nodes.
  Status evaluate(const std::vector<LoopState>& nodes, double span) {
    if (steps_ >= options_.max_steps) return Status::max_iterations;
    ++maps_;
    const auto K = std::ssize(nodes), n = scale_.size();
    segments_.clear();
    residual_.resize(K * n);
    for (Index k = 0; k < K; ++k) {
      segments_.push_back(flow(nodes[static_cast<std::size_t>(k)], span / static_cast<double>(K)));
      Segment& segment = segments_.back();
      if (segment.status != Status::converged) return segment.status;
      if (k == K - 1 && reflection_) {
        const VectorXd sign = Reflection::signs(loop_);
        segment.end = reflection_->of(loop_, segment.end);
        segment.derivative = (sign.asDiagonal() * segment.derivative).eval();
        segment.rate = sign.cwiseProduct(segment.rate);
      }
      const LoopState& next = nodes[static_cast<std::size_t>((k + 1) % K)];
      residual_.segment(k * n, n) = (as_vector(segment.end.x) - as_vector(next.x)).cwiseQuotient(scale_);
    }
    return Status::converged;
  }

  /// One damped Newton step; false if the residual does not fall.
  bool step() {
    const auto K = std::ssize(nodes_), n = scale_.size();
    MatrixXd system = MatrixXd::Zero(K * n + 1, K * n + 1);
    for (Index k = 0; k < K; ++k) {
      const Segment& segment = segments_[static_cast<std::size_t>(k)];
      system.block(k * n, k * n, n, n) = scale_.cwiseInverse().asDiagonal() * segment.derivative * scale_.asDiagonal();
      system.block(k * n, ((k + 1) % K) * n, n, n) -= MatrixXd::Identity(n, n);
      system.block(k * n, K * n, n, 1) =
          segment.rate.cwiseQuotient(scale_) * span_ / static_cast<double>(K);  // over the relative change of the span
    }
    State rate;
    field_.modes() = nodes_.front().modes;
    field_.rate(nodes_.front().x, rate, 0.0);
    system.block(K * n, 0, 1, n) = as_vector(rate).cwiseQuotient(scale_).normalized().transpose();
    VectorXd right = VectorXd::Zero(K * n + 1);
    right.head(K * n) = -residual_;
    const VectorXd change = least_squares(system, right, 1e-10);
    const double before = residual_.norm();
    const auto kept = nodes_;
    const auto kept_segments = segments_;
    const VectorXd kept_residual = residual_;
    const double kept_span = span_;
    double damping = 1.0;
    for (int halvings = 0; halvings < 6; ++halvings, damping *= 0.5) {
      move(kept, kept_segments, damping * change);
      span_ = kept_span * std::max(0.2, 1.0 + damping * change(K * n));
      if (evaluate(nodes_, span_) == Status::converged && residual_.norm() < (1.0 - 0.1 * damping) * before)
        return true;
      if (steps_ >= options_.max_steps || (options_.stop && options_.stop())) break;
    }
    nodes_ = kept;
    segments_ = kept_segments;
    residual_ = kept_residual;
    span_ = kept_span;
    return false;
  }

  /// Nodes moved by a scaled change, each in the modes in which the segment before it arrives.
  void move(const std::vector<LoopState>& from, const std::vector<Segment>& segments, const VectorXd& change) {
    const auto K = std::ssize(from), n = scale_.size();
    for (Index k = 0; k < K; ++k) {
      LoopState& node = nodes_[static_cast<std::size_t>(k)];
      const VectorXd x = as_vector(from[static_cast<std::size_t>(k)].x) + change.segment(k * n, n).cwiseProduct(scale_);
      node.x.assign(x.begin(), x.end());
      node.modes = segments[static_cast<std::size_t>((k + K - 1) % K)].end.modes;
    }
  }

  static constexpr double rtol = 1e-9;

  const Loop& loop_;
  const ShootingOptions& options_;
  LoopField field_;
  std::optional<Reflection> reflection_;
  std::vector<LoopState> nodes_;
  double span_;
  VectorXd scale_, residual_;
  std::vector<Segment> segments_;
  int maps_ = 0;
  long steps_ = 0;
};

}  // namespace

ShootingResult shoot_multiple(const Loop& loop, const OrbitGuess& guess, const ShootingOptions& options) {
  MultipleShooter shooter(loop, guess, options);
  ShootingResult result;
  result.status = shooter.solve();
  result.maps = shooter.maps();
  result.steps = shooter.steps();
  result.why = "multiple shooting did not converge";
  if (result.status != Status::converged) return result;
  Trace period;
  result.status = record(loop, shooter.start(), shooter.period(), 1e-9, 400, period);
  if (result.status != Status::converged) return result;
  const auto [low, high] = extremes(period);
  if (!(high > low)) {
    result.status = Status::no_cycle;
    result.why = "multiple shooting ended at a point of rest";
    return result;
  }
  ShootingOptions polish = options;
  polish.max_steps -= shooter.steps();
  polish.warm_maps = 0;
  polish.longest_map = 5.0 * shooter.period();
  ShootingResult polished = shoot(loop, shooter.start(), choose_section(loop, period), guess.half, polish);
  polished.steps += shooter.steps();
  return polished;
}

}  // namespace limcycle
