#include "limcycle/analysis/orbit/branch/branch_step.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/orbit/cycle/measure.hpp"
#include "limcycle/analysis/orbit/cycle/shooting.hpp"
#include "limcycle/analysis/orbit/settle/two_tolerances.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double loosest_derivatives = 3e-6;  ///< of the second integration, for derivatives and errors
constexpr double tightest_point = 3e-13;
constexpr double near_switch = 2e-3;  ///< share of the period in which the section should not meet a switch

/// [DP - I, dR/ds; normal].
MatrixXd bordered(const BranchJacobian& jacobian, const VectorXd& normal) {
  const Index m = jacobian.D.rows();
  MatrixXd J(m + 1, m + 1);
  J.topLeftCorner(m, m) = jacobian.D - MatrixXd::Identity(m, m);
  J.topRightCorner(m, 1) = jacobian.slope;
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

/// Broyden's update of rank one: afterwards the Jacobian maps the step to the change of R, which was `before`.
void learn(BranchJacobian& jacobian, const VectorXd& step, const VectorXd& before, const VectorXd& r) {
  const Index m = r.size();
  const VectorXd du = step.head(m);
  const VectorXd missed = (r - before - jacobian.D * du + du - jacobian.slope * step(m)) / step.squaredNorm();
  jacobian.D += missed * du.transpose();
  jacobian.slope += missed * step(m);
}

/// True if the motion returns in the modes in which it is begun. Begun in others, it switches at once instead of
/// before.
bool keeps_modes(const BranchSpot& spot) { return spot.value.motion.state.modes == spot.value.start.modes; }

bool nearly_neutral(const BranchSpot& spot) {
  return std::ranges::any_of(spot.multipliers, [](auto value) { return std::abs(std::abs(value) - 1.0) < 3e-3; });
}

}  // namespace

double BranchSolver::loose_rtol() const { return loose_tolerance(map_.rtol(), loosest_derivatives); }

/// A step in s that moves the image by about 1e-4 of the orbit, more with a loose integration: small against the
/// distance to the end of the branch, large against the noise of the integration.
double BranchSolver::slope_step(const VectorXd& slope, double rtol) const {
  const double size = slope.size() > 0 ? slope.norm() : 1.0;
  return std::clamp(std::clamp(std::sqrt(rtol), 1e-4, 1e-3) / std::max(size, 1e-3), 1e-9, 1e-3);
}

bool BranchSolver::fail(const BranchMap::Value& value) {
  failure_ = value.status == Status::converged ? Status::not_finite : value.status;
  invalid_ = !value.valid;
  return false;
}

std::optional<BranchSpot> BranchSolver::solve(const VectorXd& w, const VectorXd& normal, const BranchJacobian& near,
                                              Derivatives derivatives) {
  BranchSpot spot;
  spot.w = w;
  BranchJacobian jacobian = near;
  while (true) {
    if (!converge(spot, normal, jacobian)) return std::nullopt;
    if (!keeps_modes(spot)) {  // a switch has passed the section: the frame does not fit there
      failure_ = Status::stalled;
      return std::nullopt;
    }
    if (!complete(spot, normal, jacobian, derivatives)) return std::nullopt;
    if (spot.orbit_error <= accuracy_ || map_.rtol() <= tightest_point) break;
    map_.set_rtol(std::max(tightening(accuracy_, spot.orbit_error) * map_.rtol(), tightest_point));
    jacobian = spot.jacobian;
  }
  if (!fill_cycle(spot)) return std::nullopt;
  return spot;
}

/// Newton from spot.w in the plane across `normal`, until the remaining residual can be treated as a small deviation
/// (see polish). The Jacobian may be old, or empty.
bool BranchSolver::converge(BranchSpot& spot, const VectorXd& normal, BranchJacobian& jacobian) {
  const VectorXd w = spot.w;
  const Index m = map_.dimension();
  const double tolerance = std::max(3.0 * map_.rtol(), accuracy_);
  double last = infinite;
  int refreshed = 0;
  const auto refresh = [&] {
    ++refreshed;
    return differentiate(spot, loose_rtol(), Derivatives::rough, jacobian).has_value();
  };
  const auto wild = [m](const VectorXd& step) { return !step.allFinite() || step.head(m).norm() > 1.0; };
  VectorXd step, before;
  failure_ = Status::stalled;
  invalid_ = false;
  for (int i = 0; i < 14; ++i, ++spot.iterations) {
    spot.value = map_.at(spot.u(), spot.s(), BranchMap::With::trace, map_.rtol());
    if (spot.value.status != Status::converged) return fail(spot.value);
    const VectorXd& r = spot.value.r;
    const VectorXd b = joined(r, normal.dot(spot.w - w));
    if (b.norm() < tolerance || (b.norm() < 100.0 * tolerance && b.norm() > 0.5 * last)) return true;
    if (i > 0) learn(jacobian, step, before, r);
    const bool poor = b.norm() > 0.3 * last;
    if (poor && (b.norm() > 100.0 * last || refreshed > 3)) return false;
    if ((jacobian.D.size() == 0 || poor) && !refresh()) return false;
    step = solve_fully_pivoted(bordered(jacobian, normal), -b);
    if (wild(step) && refreshed == 0) {  // the Jacobian was too old
      if (!refresh()) return false;
      step = solve_fully_pivoted(bordered(jacobian, normal), -b);
    }
    if (wild(step)) return false;
    last = b.norm();
    before = r;
    spot.w += step;
  }
  return false;
}

/// Derivatives at the spot, integrated at `rtol`, and the map there. Rough ones take dR/ds on one side, if that agrees
/// with the previous derivative.
std::optional<BranchMap::Value> BranchSolver::differentiate(const BranchSpot& spot, double rtol, Derivatives wanted,
                                                            BranchJacobian& jacobian) {
  auto linear = map_.at(spot.u(), spot.s(), BranchMap::With::derivatives, rtol);
  if (linear.status != Status::converged) {
    fail(linear);
    return std::nullopt;
  }
  const double step = slope_step(jacobian.slope, rtol);
  std::optional<VectorXd> slope;
  if (wanted == Derivatives::rough && jacobian.slope.size() > 0) {
    const auto ahead = map_.at(spot.u(), spot.s() + step, BranchMap::With::nothing, rtol);
    if (ahead.status == Status::converged) slope = (ahead.r - linear.r) / step;
    if (slope && (*slope - jacobian.slope).norm() > 0.3 * jacobian.slope.norm()) slope.reset();
  }
  if (!slope) slope = map_.slope(spot.u(), spot.s(), step, linear.r, rtol);
  if (!slope) {
    invalid_ = true;
    return std::nullopt;
  }
  jacobian = {linear.D, *slope};
  return linear;
}

bool BranchSolver::complete(BranchSpot& spot, const VectorXd& normal, const BranchJacobian& near,
                            Derivatives derivatives) {
  const Index m = map_.dimension();
  spot.jacobian.slope = near.slope;
  const auto loose = differentiate(spot, loose_rtol(), Derivatives::rough, spot.jacobian);
  const auto conclude = [&] {
    spot.tangent = solve_fully_pivoted(bordered(spot.jacobian, normal), VectorXd::Unit(m + 1, m));
    if (!spot.tangent.allFinite() || spot.tangent.norm() == 0.0) return false;
    spot.tangent.normalize();
    spot.multipliers = sorted_multipliers(spot.jacobian.D);
    return true;
  };
  if (!loose || !conclude()) return false;
  // The decision on an event must not depend on rough derivatives.
  if (derivatives == Derivatives::precise || nearly_neutral(spot) || std::abs(spot.tangent(m)) < 0.02)
    if (!differentiate(spot, map_.rtol(), Derivatives::precise, spot.jacobian) || !conclude()) return false;
  polish(spot, *loose);
  return true;
}

/// Treats the remaining R as a small deviation, in the tight solution and in the loose one; their difference gives the
/// errors. The position of a point along the branch is arbitrary: it is corrected at this s, but across the branch
/// where that turns back.
void BranchSolver::polish(BranchSpot& spot, const BranchMap::Value& loose) const {
  const Index m = map_.dimension();
  const bool turns = std::abs(spot.tangent(m)) < 0.1;
  const VectorXd normal = turns ? spot.tangent : VectorXd::Unit(m + 1, m);
  const MatrixXd across =
      solve_columns_fully_pivoted(bordered(spot.jacobian, normal), MatrixXd::Identity(m + 1, m + 1));
  const VectorXd left = -across.leftCols(m) * spot.value.r, other = -across.leftCols(m) * loose.r;
  const auto corrected = [&](const BranchMap::Value& value, const VectorXd& by) {
    return std::pair(value.time + loose.time_slope * by.head(m), value.amplitude + loose.amplitude_slope * by.head(m));
  };
  const auto [time, amplitude] = corrected(spot.value, left);
  const auto [loose_time, loose_amplitude] = corrected(loose, other);
  const double second_order = 10.0 * left.squaredNorm() + 1e-4 * left.norm();
  const double share = stated_share(map_.rtol(), loose_rtol());  // of the difference of the two
  spot.w += left;
  spot.value.start.x = map_.frame().chart.lift(map_.frame().origin.x, spot.u());
  spot.value.time = time;
  spot.value.amplitude = amplitude;
  spot.left = second_order;
  const double floor = 1e-13 * across.cwiseAbs().rowwise().sum().maxCoeff();
  spot.s_error = share * std::abs(other(m) - left(m)) + second_order + floor;
  if (!turns) {
    const VectorXd moved =
        solve_fully_pivoted(bordered(spot.jacobian, spot.tangent), joined(loose.r - spot.value.r, 0.0));
    spot.s_error += share * std::abs(moved(m));
  }
  const double difference = std::max(std::abs(loose_time / time - 1.0), std::abs(loose_amplitude / amplitude - 1.0));
  spot.orbit_error = std::max(share * difference + second_order + floor, map_.rtol());
}

bool BranchSolver::fill_cycle(BranchSpot& spot) {
  const auto loop = map_.loop(spot.s());
  if (!loop) {  // the last correction left the valid range
    invalid_ = true;
    return false;
  }
  Cycle& cycle = spot.cycle;
  const bool half = map_.frame().half;
  cycle = {};
  cycle.method = "shooting";
  cycle.half_wave_symmetric = half;
  cycle.start = spot.value.start;
  cycle.period = half ? 2.0 * spot.value.time : spot.value.time;
  cycle.residual = spot.left;
  cycle.trace = spot.value.motion.trace;
  if (half) append_reflected(*loop, symmetry(*loop)->centre, cycle.trace);
  measure(*loop, cycle);
  cycle.amplitude = spot.value.amplitude;
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
    if (round.switch_distance > near_switch) break;
  }
  frame.origin = onto.state;
  frame.chart = SectionChart(frame.section, round.largest, typical_sizes(*loop));
  map_.set_frame(std::move(frame));
  return true;
}

std::optional<BranchSpot> BranchSolver::begin(const Cycle& cycle, double s) {
  const auto loop = map_.loop(s);
  if (!loop) return std::nullopt;
  Trace trace = cycle.trace;
  if (trace.t.empty()) failure_ = record(*loop, cycle.start, cycle.period, 1e-9, 1000, trace);
  if (trace.t.empty() || failure_ != Status::converged) return std::nullopt;
  // Half of the map only if the loop stays symmetric nearby: a load or an unequal level takes the symmetry away.
  bool half = cycle.half_wave_symmetric && symmetry(*loop).has_value();
  for (const double side : {-1e-3, 1e-3})
    if (const auto near = map_.loop(s + side); near && !symmetry(*near)) half = false;
  if (!place_frame(cycle.start, trace, s, half)) return std::nullopt;
  const Index m = map_.dimension();
  return solve(joined(VectorXd::Zero(m), s), VectorXd::Unit(m + 1, m), {});
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
    // The previous point, carried to the new section, gives the direction of the branch.
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
  auto moved = solve(joined(VectorXd::Zero(m), spot.s()), normal, {});
  if (!moved) return give_up();
  // Away from a fold the branch goes on to the same side, whatever states that hardly matter did on the new section.
  constexpr double far_from_fold = 0.02;
  const double ds = spot.tangent(spot.tangent.size() - 1);
  if (std::abs(ds) > far_from_fold && moved->tangent(m) * ds < 0.0) moved->tangent = -moved->tangent;
  moved->cycle = spot.cycle;
  return moved;
}

bool BranchSolver::frame_is_worn(const BranchSpot& spot) const {
  const auto& frame = map_.frame();
  const auto [low, high] = extremes(spot.cycle.trace);
  const double place = (frame.section.level - 0.5 * (low + high)) / (high - low);
  if (!(place > 0.07 && place < 0.22)) return true;
  for (Index i = 0; i < frame.chart.scale.size(); ++i) {
    const double ratio = spot.value.motion.largest[static_cast<std::size_t>(i)] / frame.chart.scale(i);
    if (ratio > 2.0 || (ratio < 0.5 && ratio > 1e-3)) return true;
  }
  return spot.value.motion.switch_distance < near_switch;
}

}  // namespace limcycle
