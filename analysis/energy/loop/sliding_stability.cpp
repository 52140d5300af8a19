#include "limcycle/analysis/energy/loop/sliding_stability.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/models/linear/dense.hpp"
#include "limcycle/models/linear/transfer.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The loop with every element in its state at linear states X, friction sliding.
LoopState first_guess(const Loop& loop, const VectorXd& X, const SteadySlide& slide, std::size_t first) {
  LoopState start = without_history(loop, X);
  std::ranges::copy(slide.z, start.x.begin() + static_cast<std::ptrdiff_t>(first));
  start.modes.back() = slide.mode;
  return start;
}

/// True if the rates at x are only rounding of their terms.
bool is_balanced(const VectorXd& rate, const MatrixXd& J, const VectorXd& x) {
  const VectorXd terms = J.cwiseAbs() * x.cwiseAbs() + 1e-3 * J.rowwise().norm();
  return (rate.cwiseAbs().array() <= 1e-9 * terms.array()).all();
}

/// Newton's method on the whole loop, in its sizes; the shortest step where states are neutral.
bool find_equilibrium(LoopField& field, State& x, const VectorXd& scale, MatrixXd& J) {
  const Index n = std::ssize(x);
  State dx, unused(x.size());
  double before = infinite;
  for (int k = 0; k < 60; ++k) {
    field.rate(x, dx, 0.0);
    if (!is_finite(dx)) return false;
    field.jacobian(x, J, 0.0, unused);
    J = (scale.cwiseInverse().asDiagonal() * J * scale.asDiagonal()).eval();
    const VectorXd rate = Eigen::Map<const VectorXd>(dx.data(), n).cwiseQuotient(scale);
    const VectorXd move = least_squares(J, -rate, 1e-13);
    const double size = move.cwiseAbs().maxCoeff();
    for (Index i = 0; i < n; ++i) x[static_cast<std::size_t>(i)] += scale(i) * move(i);
    if (size <= 1e-15 || (size < 1e-9 && !(size < 0.5 * before)))
      return is_balanced(rate, J, Eigen::Map<const VectorXd>(x.data(), n).cwiseQuotient(scale));
    before = size;
  }
  return false;
}

/// Sorts them rightmost first; those at the origin are counted and omitted.
void sort_eigenvalues(SlidingStability& result, const Eigen::VectorXcd& all) {
  std::vector<std::complex<double>> moving;
  const double fastest = all.cwiseAbs().maxCoeff();
  for (const auto& value : all)
    if (std::abs(value) > 1e-13 * fastest) moving.push_back(value);
  std::ranges::sort(moving, [](const auto& a, const auto& b) {
    return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
  });
  result.neutral = static_cast<int>(all.size() - std::ssize(moving));
  result.eigenvalues = Eigen::Map<Eigen::VectorXcd>(moving.data(), std::ssize(moving));
}

Answer judge(const SlidingStability& at) {
  if (at.eigenvalues.size() == 0) return {Decision::undecided, "the loop has no mode of its own in sliding"};
  const std::complex<double> first = at.eigenvalues(0);
  const std::string where = "sliding at " + short_number(at.velocity) + " m/s, the rightmost eigenvalue is " +
                            short_number(first.real()) +
                            (first.imag() == 0.0 ? "" : " +- " + short_number(std::abs(first.imag())) + "j") + " 1/s";
  const double rounding = 1e-14 * at.eigenvalues.cwiseAbs().maxCoeff() + 1e-11 * std::abs(first);
  if (std::abs(first.real()) <= rounding) return {Decision::undecided, where + ": on the axis, to rounding"};
  return {first.real() < 0.0 ? Decision::yes : Decision::no, where};
}

}  // namespace

SlidingStability sliding_stability(const Loop& loop) {
  SlidingStability result;
  const auto fail = [&](Decision decision, std::string why) {
    result.stable = {decision, std::move(why)};
    return result;
  };
  if (loop.ports.empty() || !loop.ports.back().rubs) return fail(Decision::not_applicable, "nothing rubs in this loop");
  if (loop.delay > 0.0) return fail(Decision::undecided, "the loop has a delay");
  const Port& port = loop.ports.back();
  bool exact = false;
  const VectorXd rest = loop.rest_point(exact);
  const double guess = (port.C_v * rest + port.c_v * loop.external).value();
  if (!(std::abs(guess) > 1e-12 * (port.C_v.cwiseAbs() * rest.cwiseAbs()).value() + 1e-300))
    return fail(Decision::not_applicable, "the body does not slide where the loop stands still");
  const auto slide = steady_slide(loop.elements.back(), guess);
  if (!slide)
    return fail(Decision::undecided, "the law has no steady sliding at " + short_number(guess) +
                                         " m/s by itself (it needs the applied force, or does not settle)");
  VectorXd force = VectorXd::Zero(std::ssize(loop.elements));
  force(force.size() - 1) = slide->force;
  const VectorXd X = loop.mean_point(force, VectorXd::Zero(force.size()), exact);
  LoopField field(loop);
  result.point = first_guess(loop, X, *slide, field.first_state(loop.elements.size() - 1));
  field.modes() = result.point.modes;
  const State typical = typical_sizes(loop);
  MatrixXd J;
  if (!find_equilibrium(field, result.point.x, Eigen::Map<const VectorXd>(typical.data(), std::ssize(typical)), J))
    return fail(Decision::undecided, "no steady sliding was found");
  std::vector<double> guards;
  field.guards(result.point.x, 0.0, guards);
  if (std::ranges::any_of(guards, [](double g) { return g < 0.0; }))
    return fail(Decision::undecided, "the steady sliding that was found is not in the modes it was looked for in");
  result.velocity = field.input(loop.elements.size() - 1).v;
  result.force = field.output(loop.elements.size() - 1);
  sort_eigenvalues(result, eigenvalues(balanced(J)));
  result.stable = judge(result);
  return result;
}

namespace {

/// Rightmost eigenvalue of steady sliding at a speed; empty if there is none.
std::optional<std::complex<double>> rightmost(const std::function<Loop(double)>& family, double speed) {
  const SlidingStability at = sliding_stability(family(speed));
  if (at.eigenvalues.size() == 0) return std::nullopt;
  return at.eigenvalues(0);
}

struct Scan {
  double speed, growth;
};

/// Speed between two at which the growth is largest (side = 1) or least (-1).
Scan extremum(const std::function<Loop(double)>& family, double low, double high, double side) {
  constexpr double ratio = 0.6180339887498949;
  const auto height = [&](double s) {
    const auto value = rightmost(family, std::exp(s));
    return value ? side * value->real() : -infinite;
  };
  double a = std::log(low), b = std::log(high);
  for (int i = 0; i < 40; ++i) {
    const double c = b - ratio * (b - a), d = a + ratio * (b - a);
    (height(c) > height(d) ? b : a) = height(c) > height(d) ? d : c;
  }
  const double s = 0.5 * (a + b);
  return {std::exp(s), side * height(s)};
}

/// A change of sign between two neighbours, unless the growth jumps there.
std::optional<HopfPoint> bisect(const std::function<Loop(double)>& family, Scan low, Scan high) {
  const double jump = std::abs(high.growth - low.growth);
  for (int i = 0; i < 60 && high.speed - low.speed > 1e-13 * high.speed; ++i) {
    const double middle = 0.5 * (low.speed + high.speed);
    const auto value = rightmost(family, middle);
    if (!value) return std::nullopt;
    ((value->real() > 0.0) == (low.growth > 0.0) ? low : high) = Scan{middle, value->real()};
  }
  if (std::abs(high.growth - low.growth) > 1e-3 * jump) return std::nullopt;
  const double speed = 0.5 * (low.speed + high.speed);
  const auto value = rightmost(family, speed);
  if (!value) return std::nullopt;
  return HopfPoint{speed, std::abs(value->imag()), high.growth < 0.0};
}

}  // namespace

std::vector<HopfPoint> sliding_stability_changes(const std::function<Loop(double)>& family, double low, double high,
                                                 const HopfOptions& options) {
  if (!(low > 0.0 && low < high && std::isfinite(high)))
    throw std::invalid_argument("speeds must be 0 < low < high, got " + short_number(low, 17) + " and " +
                                short_number(high, 17));
  std::vector<Scan> scan;
  const int points = std::max(options.points, 3);
  for (int i = 0; i <= points; ++i) {
    if (options.stop && options.stop()) return {};
    const double speed = i == points ? high : low * std::pow(high / low, double(i) / points);
    const SlidingStability at = sliding_stability(family(speed));
    const bool decided = at.stable.decision == Decision::yes || at.stable.decision == Decision::no;
    if (decided) scan.push_back({speed, at.eigenvalues(0).real()});  // on the axis to rounding: no reliable sign
  }
  std::vector<Scan> refined;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    refined.push_back(scan[i]);
    if (i == 0 || i + 1 == scan.size()) continue;
    const double side = scan[i].growth > 0.0 ? -1.0 : 1.0, here = side * scan[i].growth;
    const bool peak = here > side * scan[i - 1].growth && here >= side * scan[i + 1].growth;
    if (!peak) continue;  // its neighbours are farther from the axis: between them it may cross twice
    const Scan top = extremum(family, scan[i - 1].speed, scan[i + 1].speed, side);
    if (top.growth * side > 0.0)
      (top.speed < scan[i].speed ? refined.insert(refined.end() - 1, top) : refined.insert(refined.end(), top));
  }
  std::vector<HopfPoint> changes;
  for (std::size_t i = 0; i + 1 < refined.size(); ++i) {
    if (options.stop && options.stop()) break;
    if ((refined[i].growth > 0.0) == (refined[i + 1].growth > 0.0)) continue;
    if (const auto change = bisect(family, refined[i], refined[i + 1])) changes.push_back(*change);
  }
  return changes;
}

}  // namespace limcycle
