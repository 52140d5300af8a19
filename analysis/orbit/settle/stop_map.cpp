#include "limcycle/analysis/orbit/settle/stop_map.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/motion/working_loop.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

constexpr double between = 1.25;      ///< ratio of two displacements of a scan
constexpr double nearly_grows = 0.6;  ///< least ratio of a maximum that is looked at more closely
constexpr int refinements = 12;       ///< flights for one maximum
constexpr long steps_of_a_flight = 3000;
constexpr long switches_held = 100;  ///< of a body that has not broken away
constexpr double broken = 20.0;    ///< in lengths over which a bristle yields: a body that moved so far has broken away
constexpr double for_ever = 1e15;  ///< s: a body that the controller does not push waits so long

/// The loop with its body held, as far as it is linear.
struct HeldLoop {
  const Loop& loop;
  Eigen::VectorXd sizes;               ///< of the linear states
  Eigen::MatrixXd scaled;              ///< the matrix of their rates, in these sizes
  Eigen::RowVectorXd velocity, force;  ///< of the body, and on it

  explicit HeldLoop(const Loop& of) : loop(of) {
    const State typical = typical_sizes(loop);
    sizes = Eigen::Map<const Eigen::VectorXd>(typical.data(), loop.states());
    const Eigen::MatrixXd A = working_loop(loop);
    const Eigen::VectorXd push = loop.B.rightCols<1>();
    velocity = loop.ports.back().C_v;
    force = velocity * A;
    const Eigen::MatrixXd held = A - push * force / velocity.dot(push.transpose());
    scaled = sizes.cwiseInverse().asDiagonal() * held * sizes.asDiagonal();
  }

  /// The states, from the rest point, at which the body has been held at y = 1 for long and all that still moves does
  /// so with exp(-leak t), at the moment at which no force acts on it: H X = X', H X' = -leak X', C_v X = C_v A X = 0
  /// and C_y X = 1, the smallest such X and X' in their typical sizes. With leak = 0 the loop winds up steadily. Empty
  /// if there is none, or if the force stays.
  Eigen::VectorXd winding_up(double leak) const {
    const Eigen::Index n = loop.states();
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(n, n);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2 * n + 3, 2 * n);
    rows.topLeftCorner(n, n) = scaled;
    rows.topRightCorner(n, n) = -one;
    rows.block(n, n, n, n) = scaled + leak * one;
    rows.bottomLeftCorner(3, n) << loop.C_y, velocity, force;
    rows.bottomLeftCorner(3, n) *= sizes.asDiagonal();
    Eigen::VectorXd wanted = Eigen::VectorXd::Zero(2 * n + 3);
    wanted(2 * n) = 1.0;
    equilibrate(rows, wanted);
    const Eigen::VectorXd found = least_squares(rows, wanted);
    if (!found.allFinite() || (rows * found - wanted).norm() > 1e-6 * wanted.norm()) return {};
    Eigen::VectorXd X = sizes.cwiseProduct(found.head(n));
    const Eigen::VectorXd rising = sizes.cwiseProduct(found.tail(n));
    if (std::abs(force.dot(rising.transpose())) <= 1e-9 * force.cwiseAbs().dot(rising.cwiseAbs().transpose()))
      return {};
    return X;
  }
};

/// Those states for a loop with integral action, or with one that leaks: then with the slowest of its rates, which is
/// slower than the closed loop. (A lag or a filter, which leaks too, is a part of the motion and winds nothing up.)
Eigen::VectorXd steady_hold(const Loop& loop) {
  const HeldLoop held(loop);
  if (Eigen::VectorXd X = held.winding_up(0.0); X.size() > 0) return X;
  constexpr double is_real = 1e-9;
  const double closed_loop = 1.0 / slow_time(loop);
  std::vector<double> leaks;
  for (const auto& pole : eigenvalues(held.scaled))
    if (pole.real() < 0.0 && -pole.real() < closed_loop && std::abs(pole.imag()) <= -is_real * pole.real())
      leaks.push_back(-pole.real());
  std::ranges::sort(leaks);
  for (const double leak : leaks)
    if (Eigen::VectorXd X = held.winding_up(leak); X.size() > 0) return X;
  return {};
}

}  // namespace

StopMap::StopMap(const Loop& loop, double rtol, std::function<bool()> stop)
    : loop_(&loop), weights_(loop_weights(loop, rtol)), stop_(std::move(stop)) {}

std::optional<StopMap> StopMap::of(const Loop& loop, double rtol, std::function<bool()> stop) {
  if (loop.continuous || loop.states() == 0 || loop.elements.empty() || !loop.ports.back().rubs) return std::nullopt;
  const Element& law = loop.elements.back();
  const bool holds = law.may_stick() && law.facts().stuck;
  if (!holds && !(law.states() > 0 && std::isfinite(law.scales().displacement))) return std::nullopt;
  bool exact = false;
  StopMap map(loop, rtol, std::move(stop));
  map.rest_ = loop.rest_point(exact);
  if (!exact) return std::nullopt;
  map.held_ = steady_hold(loop);
  if (map.held_.size() == 0) return std::nullopt;
  return map;
}

LoopState StopMap::held_at(double p) const {
  LoopState state = without_history(*loop_, rest_ + p * held_);
  if (const auto stuck = loop_->elements.back().facts().stuck) state.modes.back() = *stuck;
  return state;
}

bool StopMap::stops(const LoopField& field, const State& x) {
  const Eigen::Map<const Eigen::VectorXd> X(x.data(), loop_->states());
  const Port& port = loop_->ports.back();
  const double at = port.C.dot(X.transpose()), v = port.C_v.dot(X.transpose());
  if (!flight_) flight_ = Flight{at, false, v};
  const Element& law = loop_->elements.back();
  const bool held = law.may_stick() ? field.holds(loop_->elements.size() - 1) : v * flight_->v <= 0.0;
  const bool away = law.may_stick() ? !held : std::abs(at - flight_->from) > broken * law.scales().displacement;
  const bool stopped = flight_->moved && held;
  flight_->moved = flight_->moved || away;
  flight_->v = v;
  return stopped;
}

std::optional<double> StopMap::ratio(double p) {
  const LoopState start = held_at(p);
  LoopField field(*loop_);
  field.modes() = start.modes;
  March march(field, StepperKind::automatic, weights_);
  march.begin(start.x, 0.0);
  flight_.reset();
  std::optional<double> found;
  // A body that does not break away trembles on its bristles, for thousands of switches.
  const long most_held = switches_held + 2 * loop_->elements.back().states();
  const auto trembles = [&] { return flight_ && !flight_->moved && march.events() > most_held; };
  while (march.steps() < steps_of_a_flight && !found && !trembles() && !(stop_ && stop_())) {
    if (march.step(for_ever) != Status::converged || march.t() >= for_ever) break;
    if (stops(field, march.x())) found = std::abs(field.y(march.x()) - loop_->C_y.dot(rest_.transpose())) / p;
  }
  steps_ += march.steps();
  return found;
}

/// A displacement between two from which the swings grow, if the largest ratio is more than 1: by golden section in the
/// logarithm of the displacement.
std::optional<double> StopMap::growing_between(double low, double high) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double a = std::log(low), b = std::log(high), c = b - golden * (b - a), d = a + golden * (b - a);
  double at_c = ratio(std::exp(c)).value_or(0.0), at_d = ratio(std::exp(d)).value_or(0.0);
  for (int i = 0; i < refinements && std::max(at_c, at_d) <= 1.0; ++i) {
    if (at_c > at_d) {
      b = d;
      d = c;
      at_d = at_c;
      c = b - golden * (b - a);
      at_c = ratio(std::exp(c)).value_or(0.0);
    } else {
      a = c;
      c = d;
      at_c = at_d;
      d = a + golden * (b - a);
      at_d = ratio(std::exp(d)).value_or(0.0);
    }
  }
  if (std::max(at_c, at_d) <= 1.0) return std::nullopt;
  return std::exp(at_c > at_d ? c : d);
}

/// A displacement between two from which the swings grow, if the ratio rises steadily as the displacement falls and
/// passes 1 before it jumps down: by bisection for the jump. `upper` is the ratio at `high`, `rise` its increase per
/// unit of the logarithm, `lower` the ratio below the jump.
std::optional<double> StopMap::growing_above_jump(double low, double high, double upper, double rise, double lower) {
  const double from = high;
  for (int i = 0; i < refinements; ++i) {
    const double p = std::sqrt(low * high), expected = upper + rise * std::log(from / p), now = ratio(p).value_or(0.0);
    if (now > 1.0) return p;
    (now > 0.5 * (expected + lower) ? high : low) = p;
  }
  return std::nullopt;
}

/// A displacement between one from which the swings grow and one from which the body does not break away, where the
/// integral has no effect: if there is one, from which they shrink, else the last from which it does. By bisection.
double StopMap::growing_below_jump(double low, double high) {
  for (int i = 0; i < refinements; ++i) {
    const double p = std::sqrt(low * high), now = ratio(p).value_or(0.0);
    if (now > 0.0 && now <= 1.0) return p;
    (now > 0.0 ? low : high) = p;
  }
  return low;
}

/// A displacement hardly above the one at which the swings repeat themselves, which lies between one from which they
/// grow and one from which they shrink: by bisection. Where the next swing is followed by none, the range of attraction
/// is narrow.
double StopMap::shrinking_above(double low, double high) {
  constexpr int halvings = 6;
  for (int i = 0; i < halvings; ++i) {
    const double p = std::sqrt(low * high), now = ratio(p).value_or(0.0);
    (now > 0.0 && now <= 1.0 ? high : low) = p;
  }
  return high;
}

std::vector<double> StopMap::growing(double least, double most) {
  std::vector<double> places, ratios, found;
  for (double p = most; p >= least && !(stop_ && stop_()); p /= between) {
    places.push_back(p);
    ratios.push_back(ratio(p).value_or(0.0));
  }
  for (std::size_t i = 1; i < places.size(); ++i) {  // from the largest down
    if (ratios[i] > 1.0 && ratios[i - 1] > 0.0 && ratios[i - 1] < 1.0)
      found.insert(found.end(), {places[i], shrinking_above(places[i], places[i - 1])});
    if (ratios[i] > 1.0 && ratios[i - 1] == 0.0) found.push_back(growing_below_jump(places[i], places[i - 1]));
    if (ratios[i] > 1.0) continue;
    const double rise = i > 1 && ratios[i - 2] > 0.0 && ratios[i - 1] < 1.0 ? ratios[i - 1] - ratios[i - 2] : 0.0;
    if (rise > 0.0 && ratios[i - 1] + 2.0 * rise > 1.0)
      if (const auto p =
              growing_above_jump(places[i], places[i - 1], ratios[i - 1], rise / std::log(between), ratios[i]))
        found.push_back(*p);
    if (i + 1 == places.size() || ratios[i] < nearly_grows) continue;
    if (ratios[i] <= ratios[i - 1] || ratios[i] < ratios[i + 1]) continue;
    if (const auto p = growing_between(places[i + 1], places[i - 1])) found.push_back(*p);
  }
  return found;
}

}  // namespace limcycle
