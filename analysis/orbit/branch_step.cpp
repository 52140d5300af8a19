#include "limcycle/analysis/orbit/branch_step.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/measure.hpp"
#include "limcycle/analysis/orbit/shooting.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double loose_factor = 30.0;  ///< the second integration tolerance, for the error
constexpr long steps_a_map = 200000;

/// [DP - I, dR/ds; normal].
MatrixXd bordered(const MatrixXd& D, const VectorXd& slope, const VectorXd& normal) {
  const Index m = D.rows();
  MatrixXd J(m + 1, m + 1);
  J.topLeftCorner(m, m) = D - MatrixXd::Identity(m, m);
  J.topRightCorner(m, 1) = slope;
  J.bottomRows(1) = normal.transpose();
  return J;
}

std::vector<std::complex<double>> sorted_multipliers(const MatrixXd& D) {
  if (D.size() == 0) return {};
  const Eigen::VectorXcd values = eigenvalues(D);
  std::vector<std::complex<double>> result(values.begin(), values.end());
  std::ranges::sort(result, [](auto a, auto b) {
    return std::abs(a) != std::abs(b) ? std::abs(a) > std::abs(b) : a.imag() > b.imag();
  });
  return result;
}

VectorXd joined(const VectorXd& u, double s) {
  VectorXd w(u.size() + 1);
  w << u, s;
  return w;
}

/// Does an element switch within this share of the period of the moment at which the orbit is on the section? There the
/// map is a different function on either side.
bool switches_near(const Loop& loop, const LoopState& start, double time) {
  constexpr double share = 2e-3;
  LoopField field(loop);
  field.modes() = start.modes;
  March march(field, StepperKind::automatic, loop_weights(loop, 1e-8));
  march.begin(start.x, 0.0);
  while (march.t() < time) {
    if (march.steps() > steps_a_map || march.step(time) != Status::converged) return true;
    const double at = march.t() / time;
    if (march.last().switched && (at < share || at > 1.0 - share)) return true;
  }
  return false;
}

}  // namespace

/// A step in s that moves the image by about 1e-4 of the orbit: small against the distance to where the branch ends,
/// large against the noise of the integration.
double BranchSolver::slope_step(const VectorXd& slope) const {
  const double size = slope.size() > 0 ? slope.norm() : 1.0;
  return std::clamp(1e-4 / std::max(size, 1e-3), 1e-9, 1e-3);
}

std::optional<BranchSpot> BranchSolver::solve(const VectorXd& w, const VectorXd& normal, const VectorXd& slope) {
  BranchSpot spot;
  spot.w = w;
  spot.slope = slope;
  const Index m = map_.dimension();
  const double tolerance = 30.0 * map_.rtol();
  double last = infinite;
  failure_ = Status::stalled;
  invalid_ = false;
  for (spot.iterations = 0; spot.iterations < 12; ++spot.iterations) {
    spot.value = map_.at(spot.u(), spot.s(), true);
    if (spot.value.status != Status::converged || !spot.value.D.allFinite()) {
      failure_ = spot.value.status == Status::converged ? Status::not_finite : spot.value.status;
      invalid_ = !spot.value.valid;
      return std::nullopt;
    }
    const VectorXd b = joined(spot.value.r, normal.dot(spot.w - w));
    const bool floor = b.norm() < 100.0 * tolerance && b.norm() > 0.5 * last;
    if (b.norm() < tolerance || floor) return complete(spot, normal) ? std::optional(std::move(spot)) : std::nullopt;
    if (b.norm() > 0.3 * last) {
      if (b.norm() > 2.0 * last || spot.iterations > 6) return std::nullopt;
      const auto fresh = map_.slope(spot.u(), spot.s(), slope_step(spot.slope), spot.value.r);
      if (!fresh) return std::nullopt;
      spot.slope = *fresh;
    }
    last = b.norm();
    const VectorXd step = solve_fully_pivoted(bordered(spot.value.D, spot.slope, normal), -b);
    if (!step.allFinite() || step.head(m).norm() > 1.0) return std::nullopt;
    spot.w += step;
  }
  return std::nullopt;
}

bool BranchSolver::complete(BranchSpot& spot, const VectorXd& normal) {
  const Index m = map_.dimension();
  const auto slope = map_.slope(spot.u(), spot.s(), slope_step(spot.slope), spot.value.r);
  const auto loose = map_.at(spot.u(), spot.s(), false, loose_factor * map_.rtol());
  if (!slope || loose.status != Status::converged) {
    failure_ = loose.status == Status::converged ? Status::stalled : loose.status;
    invalid_ = !slope;
    return false;
  }
  spot.slope = *slope;
  const auto J = bordered(spot.value.D, spot.slope, normal).fullPivLu();
  spot.tangent = J.solve(VectorXd::Unit(m + 1, m));
  if (!spot.tangent.allFinite() || spot.tangent.norm() == 0.0) return false;
  spot.tangent.normalize();
  spot.multipliers = sorted_multipliers(spot.value.D);
  const auto across = bordered(spot.value.D, spot.slope, spot.tangent).fullPivLu();
  const VectorXd error = across.solve(joined(loose.r - spot.value.r, 0.0)).cwiseAbs() +
                         across.solve(joined(spot.value.r, 0.0)).cwiseAbs() +
                         VectorXd::Constant(m + 1, 1e-13 * across.inverse().cwiseAbs().rowwise().sum().maxCoeff());
  spot.s_error = error(m);
  spot.orbit_error = std::max({error.head(m).norm(), std::abs(loose.time / spot.value.time - 1.0), map_.rtol()});
  return true;
}

bool BranchSolver::measure_spot(BranchSpot& spot) {
  const auto loop = map_.loop(spot.s());
  Cycle& cycle = spot.cycle;
  const bool half = map_.frame().half;
  cycle = {};
  cycle.method = "shooting";
  cycle.half_wave_symmetric = half;
  cycle.start = spot.value.start;
  cycle.period = half ? 2.0 * spot.value.time : spot.value.time;
  cycle.residual = spot.value.r.norm();
  if (record(*loop, cycle.start, cycle.period, map_.rtol(), 1000, cycle.trace) != Status::converged) return false;
  measure(*loop, cycle);
  // The chart measures in units of the states on the orbit; the amplitude is that of y alone.
  cycle.error = spot.orbit_error;
  cycle.multipliers = spot.multipliers;
  for (auto& multiplier : cycle.multipliers)
    if (half) multiplier *= multiplier;
  const double largest = spot.multipliers.empty() ? 0.0 : std::abs(spot.multipliers.front());
  if (std::abs(largest - 1.0) > 1e-5) cycle.stable = largest < 1.0;
  return std::isfinite(cycle.amplitude) && cycle.amplitude > 0.0;
}

bool BranchSolver::place_frame(const LoopState& start, const Trace& trace, double s, bool half) {
  const auto loop = map_.loop(s);
  if (!loop) return false;
  BranchMap::Frame frame;
  frame.section = choose_section(*loop, trace);
  frame.half = half;
  const auto reflection = half ? symmetry(*loop) : std::nullopt;
  const auto [low, high] = extremes(trace);
  ReturnMap::Result onto, round;
  for (const double shift : {0.0, -0.04, 0.07, -0.05}) {  // off a switch
    frame.section.level += shift * (high - low);
    ReturnMap map(*loop, frame.section, reflection, {map_.rtol(), steps_a_map, {}});
    onto = map.approach(start);
    if (onto.status != Status::converged) return false;
    round = map(onto.state);
    if (round.status != Status::converged) return false;
    if (!switches_near(*loop, onto.state, round.time)) break;
  }
  frame.origin = onto.state;
  frame.chart = SectionChart(frame.section, round.largest, typical_sizes(*loop));
  map_.set_frame(std::move(frame));
  return true;
}

std::optional<BranchSpot> BranchSolver::begin(const Cycle& cycle, double s) {
  const auto loop = map_.loop(s);
  if (!loop) return std::nullopt;
  Trace trace;
  failure_ = record(*loop, cycle.start, cycle.period, 1e-9, 1000, trace);
  if (failure_ != Status::converged) return std::nullopt;
  // Half of the map only if the loop stays symmetric nearby: a load or an unequal level takes the symmetry away.
  bool half = cycle.half_wave_symmetric && symmetry(*loop).has_value();
  for (const double side : {-1e-3, 1e-3})
    if (const auto near = map_.loop(s + side); near && !symmetry(*near)) half = false;
  if (!place_frame(cycle.start, trace, s, half)) return std::nullopt;
  const Index m = map_.dimension();
  const VectorXd fixed = VectorXd::Unit(m + 1, m);
  const auto slope = map_.slope(VectorXd::Zero(m), s, slope_step({}), VectorXd::Zero(m));
  if (!slope) return std::nullopt;
  auto spot = solve(joined(VectorXd::Zero(m), s), fixed, *slope);
  if (!spot || !measure_spot(*spot)) return std::nullopt;
  return spot;
}

std::optional<BranchSpot> BranchSolver::reframe(const BranchSpot& spot, const BranchSpot* before, double direction) {
  const BranchMap::Frame old = map_.frame();
  const auto give_up = [&]() -> std::optional<BranchSpot> {
    map_.set_frame(old);
    return std::nullopt;
  };
  if (!place_frame(spot.value.start, spot.cycle.trace, spot.s(), old.half)) return give_up();
  const Index m = map_.dimension();
  VectorXd normal = direction * VectorXd::Unit(m + 1, m);
  if (before) {
    // The point before, carried to the new section, tells where the branch is going.
    const auto loop = map_.loop(before->s());
    const auto half = map_.frame().half ? symmetry(*loop) : std::nullopt;
    ReturnMap map(*loop, map_.frame().section, half, {map_.rtol(), steps_a_map, {}});
    const auto there = map.approach(before->value.start);
    if (there.status != Status::converged) return give_up();
    const VectorXd u = map_.frame().chart.coordinates(there.state.x, map_.frame().origin.x);
    normal = joined(-u, spot.s() - before->s());
    if (!(normal.norm() > 0.0)) return give_up();
    normal.normalize();
  }
  const auto slope = map_.slope(VectorXd::Zero(m), spot.s(), slope_step(spot.slope), VectorXd::Zero(m));
  if (!slope) return give_up();
  auto moved = solve(joined(VectorXd::Zero(m), spot.s()), normal, *slope);
  if (!moved) return give_up();
  moved->cycle = spot.cycle;
  return moved;
}

bool BranchSolver::frame_is_worn(const BranchSpot& spot) const {
  const auto& frame = map_.frame();
  const auto [low, high] = extremes(spot.cycle.trace);
  const double place = (frame.section.level - 0.5 * (low + high)) / (high - low);
  if (!(place > 0.07 && place < 0.22)) return true;
  for (Index i = 0; i < frame.chart.scale.size(); ++i) {
    const double ratio = spot.value.largest[static_cast<std::size_t>(i)] / frame.chart.scale(i);
    if (ratio > 2.0 || (ratio < 0.5 && ratio > 1e-3)) return true;
  }
  return switches_near(*map_.loop(spot.s()), spot.value.start, spot.value.time);
}

}  // namespace limcycle
