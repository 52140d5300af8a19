#include "limcycle/analysis/energy/loop/stuck_set.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/models/linear/dense.hpp"
#include "limcycle/models/linear/transfer.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double negligible = 1e-10;

/// The affine set A X + B F + E ext = 0, C_v X + c_v ext = 0 in the unknowns (X, F), in the sizes of the loop.
struct Equilibria {
  VectorXd point;   ///< the one of least norm; (X, F)
  MatrixXd kernel;  ///< projector on the directions of the set, in scaled unknowns
  VectorXd scale;
  int dimension = 0;
  bool solvable = false;

  explicit Equilibria(const Loop& loop) {
    const Index n = loop.states();
    const State typical = typical_sizes(loop);
    scale.resize(n + 1);
    scale.head(n) = Eigen::Map<const VectorXd>(typical.data(), n);
    scale(n) = loop.elements.back().scales().output;
    const Port& port = loop.ports.back();
    MatrixXd M(n + 1, n + 1);
    M << loop.A, loop.B.rightCols(1), port.C_v, 0.0;
    VectorXd pull(n + 1);
    pull << loop.E * loop.external, port.c_v.dot(loop.external.transpose());
    M = (M * scale.asDiagonal()).eval();
    equilibrate(M, pull);
    const VectorXd u = least_squares(M, -pull, negligible);
    solvable = (M * u + pull).norm() <= 1e-9 * (pull.norm() + u.norm());
    kernel = MatrixXd::Identity(n + 1, n + 1);
    for (Index i = 0; i <= n; ++i) kernel.col(i) -= least_squares(M, M.col(i), negligible);
    dimension = static_cast<int>(std::lround(kernel.trace()));
    point = scale.cwiseProduct(u);
  }

  /// d(row of the unknowns) along the direction of the set in which the force changes by 1 N; nothing if it cannot.
  std::optional<VectorXd> along_force() const {
    const Index n = scale.size() - 1;
    const VectorXd direction = kernel.col(n);
    if (direction.norm() < 1e-7) return std::nullopt;
    return VectorXd(scale.cwiseProduct(direction) / (direction(n) * scale(n)));
  }

  /// True if this row (of X) can change at constant force.
  bool free(const Eigen::RowVectorXd& row) const {
    const Index n = scale.size() - 1;
    Eigen::RowVectorXd scaled = Eigen::RowVectorXd::Zero(n + 1);
    scaled.head(n) = row.cwiseProduct(scale.head(n).transpose());
    const Eigen::RowVectorXd reach = scaled * kernel;
    const VectorXd direction = kernel.col(n);
    const double norm = direction.norm();
    const VectorXd across = norm < 1e-7
                                ? VectorXd(reach.transpose())
                                : VectorXd(reach.transpose() - direction * (reach * direction).value() / (norm * norm));
    return across.norm() > 1e-7 * scaled.norm();
  }
};

/// Rightmost first.
Eigen::VectorXcd sorted(Eigen::VectorXcd values) {
  std::ranges::sort(values, [](const auto& a, const auto& b) {
    return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
  });
  return values;
}

/// The motion of a stuck body: X' = (I - B C_v/(C_v B)) A X within C_v X = 0, in the sizes of the loop.
MatrixXd stuck_motion(const Loop& loop, const VectorXd& scale) {
  const Index n = loop.states();
  const Port& port = loop.ports.back();
  const VectorXd B = loop.B.rightCols(1);
  const MatrixXd held = loop.A - B * (port.C_v * loop.A) / (port.C_v * B).value();
  const MatrixXd S = scale.head(n).cwiseInverse().asDiagonal() * held * scale.head(n).asDiagonal();
  const VectorXd row = port.C_v.transpose().cwiseProduct(scale.head(n));
  const MatrixXd Q = Eigen::HouseholderQR<MatrixXd>(row).householderQ() * MatrixXd::Identity(n, n);
  return Q.rightCols(n - 1).transpose() * S * Q.rightCols(n - 1);
}

/// The motion about a state of the set with the bristles of the law.
MatrixXd bristle_motion(const Loop& loop, const LoopState& at) {
  LoopField field(loop);
  field.modes() = at.modes;
  MatrixXd J;
  State dx, unused(field.size());
  field.rate(at.x, dx, 0.0);
  field.jacobian(at.x, J, 0.0, unused);
  return J;
}

Answer judge(const StuckSet& set, bool stuck, const Extent& stops, int zero) {
  std::vector<std::complex<double>> values(set.eigenvalues.begin(), set.eigenvalues.end());
  std::ranges::sort(values, {}, [](const auto& s) { return std::abs(s); });
  double rightmost = -infinite;
  for (auto i = static_cast<std::size_t>(zero); i < values.size(); ++i)
    rightmost = std::max(rightmost, values[i].real());
  const double rounding = values.empty() ? 0.0 : 1e-12 * std::abs(values.back());
  const std::string slowest =
      std::isinf(rightmost) ? "" : " (rightmost eigenvalue nearby: real part " + short_number(rightmost) + " 1/s)";
  if (set.winding > 0) return {Decision::no, "unstable: the stuck loop winds up until the body breaks away"};
  if (rightmost > rounding) return {Decision::no, "unstable: motions near the set grow" + slowest};
  if (rightmost > -rounding)
    return {Decision::undecided, "marginal to rounding: a mode near the set neither grows nor decays"};
  if (!stuck) return {Decision::yes, "locally stable near its centre" + slowest};
  const Extent inner{std::max(set.force.low, stops.low), std::min(set.force.high, stops.high)};
  if (inner.low > inner.high) return {Decision::no, "no state of the set stops a moving body"};
  const double doubt = 1e-6 * (stops.high - stops.low);
  if (inner.high < set.force.high - doubt || inner.low > set.force.low + doubt)
    return {Decision::yes, "locally stable where the friction is between " + short_number(inner.low) + " and " +
                               short_number(inner.high) + " N; elsewhere it holds only what is undisturbed" + slowest};
  return {Decision::yes, "locally stable" + slowest};
}

/// Distance of linear states from the set, in the sizes of the loop; the force does not count.
double distance(const Equilibria& set, const State& x, double force) {
  const Index n = set.scale.size() - 1;
  VectorXd away(n + 1);
  for (Index i = 0; i < n; ++i) away(i) = (x[static_cast<std::size_t>(i)] - set.point(i)) / set.scale(i);
  away(n) = (force - set.point(n)) / set.scale(n);
  return (away - set.kernel * away).head(n).norm();
}

/// Marches from X; true if the motion ends in the set, or is on its way there: ever nearer.
bool comes_back(const Loop& loop, const Equilibria& set, const VectorXd& X, double duration,
                const StuckOptions& options) {
  const LoopState from = without_history(loop, X);
  LoopField field(loop);
  field.modes() = from.modes;
  constexpr double rtol = 1e-7, in_the_set = 1e-8;
  March march(field, choose_stepper(loop, rtol), loop_weights(loop, rtol));
  State dx;
  const auto away = [&] {
    field.rate(march.x(), dx, 0.0);
    return distance(set, march.x(), field.output(loop.elements.size() - 1));
  };
  march.begin(from.x, 0.0);
  double half_way = away();
  for (const double until : {0.5 * duration, duration}) {
    const double before = half_way;
    for (long k = 0; k < options.max_steps && march.t() < until; ++k)
      if ((options.stop && options.stop()) || march.step(until) != Status::converged) return false;
    half_way = away();
    if (half_way > std::max(0.5 * before, in_the_set)) return false;
  }
  return true;
}

/// The body displaced, or pushed so that friction alone would stop it within that displacement, both ways.
void march_back(const Loop& loop, const Equilibria& set, const VectorXd& middle, StuckSet& result,
                const StuckOptions& options) {
  const Index n = loop.states();
  double slowest = infinite;
  for (const std::complex<double> s : result.eigenvalues)
    if (-s.real() > 1e-9 * result.eigenvalues.cwiseAbs().maxCoeff()) slowest = std::min(slowest, -s.real());
  for (const double modulus : pole_moduli(loop)) slowest = std::min(slowest, modulus);
  const double duration = std::isfinite(slowest) ? 10.0 / slowest : 10.0;
  const Port& port = loop.ports.back();
  VectorXd shift = VectorXd::Zero(n);
  for (Index i = 0; i < n; ++i) shift(i) = port.C(i) * set.scale(i) * set.scale(i);
  const double size = (port.C * shift).value();
  if (!(size > 0.0)) return;
  const double bristles = 0.1 * loop.elements.back().scales().displacement;  // the bristles reach no farther
  const double way = std::min(1e-3 * std::sqrt(size), bristles);
  shift *= way / size;
  const VectorXd B = loop.B.rightCols(1);
  const double reach = (port.C_v * B).value();
  const double speed = std::sqrt(set.scale(n) * std::abs(reach) * way);
  const VectorXd push = reach == 0.0 ? VectorXd(VectorXd::Zero(n)) : VectorXd(B * (speed / reach));
  for (const VectorXd& move : {push, VectorXd(-push), shift, VectorXd(-shift)}) {
    if (move.isZero(0.0)) continue;
    ++result.tried;
    if (comes_back(loop, set, middle + move, duration, options)) ++result.returned;
  }
}

Extent ends(double a, double b) { return {std::min(a, b), std::max(a, b)}; }

/// Range of y over the set, for this range of the force.
Extent outputs(const Loop& loop, const Equilibria& set, const Extent& force) {
  const Index n = loop.states();
  if (set.free(loop.C_y)) return {-infinite, infinite};
  const double y = loop.output_origin + (loop.C_y * set.point.head(n)).value(), F = set.point(n);
  const auto along = set.along_force();
  if (!along) return {y, y};
  const double slope = (loop.C_y * along->head(n)).value();
  const double size = (loop.C_y.cwiseAbs() * set.scale.head(n)).value();
  if (std::abs(slope) * set.scale(n) <= 1e-12 * size) return {y, y};
  return ends(y + slope * (force.low - F), y + slope * (force.high - F));
}

/// Linear states of the set whose friction is F.
VectorXd states_at(const Equilibria& set, double F) {
  const Index n = set.scale.size() - 1;
  const auto along = set.along_force();
  const VectorXd point = along ? VectorXd(set.point + *along * (F - set.point(n))) : set.point;
  return point.head(n);
}

/// Decides the attraction of the set, for motions near it.
void decide_attraction(const Loop& loop, const Equilibria& set, double middle, const Extent& stops, StuckSet& result) {
  const bool stuck = sticks(loop.elements.back());
  if (!stuck && std::abs(middle) > 1e-9 * set.scale(loop.states())) {
    result.attracts = {Decision::undecided, "the middle of the set needs deflected bristles"};
    return;
  }
  const MatrixXd J = balanced(stuck ? stuck_motion(loop, set.scale)
                                    : bristle_motion(loop, without_history(loop, states_at(set, middle))));
  const ZeroModes zero = zero_modes(J);
  result.winding = zero.times - zero.directions;
  if (J.size() > 0) result.eigenvalues = sorted(eigenvalues(J));
  result.attracts = judge(result, stuck, stops, zero.times);
}

/// Reason why the question does not apply to this loop, or nothing.
std::optional<std::string> not_for(const Loop& loop) {
  if (loop.elements.empty() || !loop.ports.back().opposes) return "there is no friction in the loop";
  if (loop.elements.size() > 1) return "the rest of the loop is not linear: " + loop.ports.front().path;
  if (loop.delay > 0.0) return "the loop has a delay";
  return std::nullopt;
}

}  // namespace

StuckSet stuck_set(const Loop& loop, const StuckOptions& options) {
  StuckSet result;
  const auto fail = [&](Decision decision, std::string why) {
    result.answer = {decision, std::move(why)};
    result.attracts = {Decision::not_applicable, "there is no set of stuck states"};
    result.dimension = -1;
    return result;
  };
  if (const auto why = not_for(loop)) return fail(Decision::not_applicable, *why);
  const Extent holds = holding_forces(loop.elements.back()), stops = stopping_forces(loop.elements.back());
  const Equilibria set(loop);
  if (!set.solvable) return fail(Decision::no, "nothing stands still with the rubbing velocity at zero");
  const double F = set.point(loop.states());
  const bool varies = set.along_force().has_value();
  if (!varies && (F < holds.low || F > holds.high))
    return fail(Decision::no, "standing still takes a force of " + short_number(F) + " N, more than the law holds");
  result.dimension = set.dimension;
  result.force = varies ? holds : Extent{F, F};
  result.output = outputs(loop, set, result.force);
  const std::string low = short_number(result.output.low), high = short_number(result.output.high);
  result.answer = {Decision::yes,
                   "the loop can stand still with friction between " + short_number(result.force.low) + " and " +
                       short_number(result.force.high) + " N" +
                       (low == high ? ", only at y = " + low : " and y between " + low + " and " + high)};
  const double middle = varies ? 0.5 * (std::max(holds.low, stops.low) + std::min(holds.high, stops.high)) : F;
  decide_attraction(loop, set, middle, stops, result);
  if (options.march) march_back(loop, set, states_at(set, middle), result, options);
  return result;
}

}  // namespace limcycle
