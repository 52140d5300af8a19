#include "limcycle/models/delay.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "limcycle/models/element/of_controllers/sampled.hpp"
#include "limcycle/models/element/with_memory/delayed_relay.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"
#include "limcycle/models/linear/dense.hpp"
#include "limcycle/models/measured/plants_of_loop.hpp"

namespace limcycle {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

void check_order(int order) {
  if (order < lowest_pade_order || order > highest_pade_order)
    throw std::invalid_argument("order of the Pade approximation of a delay = " + std::to_string(order) + ": must be " +
                                std::to_string(lowest_pade_order) + ".." + std::to_string(highest_pade_order));
}

/// k-th partial denominator of the continued fraction of tanh(x/2): 2, 6, 10, ...
double denominator(Index k) { return 4.0 * static_cast<double>(k) - 2.0; }

/// Computes the rates of the inputs from their rows, for inputs that read present states only.
void make_rates(Loop& loop) {
  for (std::size_t i = 0; i < loop.ports.size(); ++i) {
    Port& port = loop.ports[i];
    if (port.rubs) continue;
    port.C_v = port.C * loop.A;
    port.D_v = port.C * loop.B;
    port.c_v = port.C * loop.E;
    port.c_v(reference_slope) += port.c(reference_value);
    const bool needs_rate = loop.elements[i].facts().needs_rate;
    // A direct path through the approximation also enters the rate. An entry of rounding size closes no loop.
    const auto own = static_cast<Index>(i);
    const double size = (port.C.cwiseAbs() * loop.B.cwiseAbs()).maxCoeff();
    for (Index k = 0; k < port.D_v.size(); ++k)
      if (std::abs(port.D_v(k)) <= 1e-13 * size) port.D_v(k) = 0.0;
    if (needs_rate && !port.D_v.tail(port.D_v.size() - own).isZero(0.0))
      throw std::invalid_argument("loop.plant.delay: " + port.path +
                                  " needs the rate of its input, which the approximation of the delay makes depend on "
                                  "its own output: add loop.controller.lag");
  }
}

Loop without_delay(Loop loop) {
  loop.A += loop.A_delayed;
  loop.A_delayed.setZero();
  for (auto& port : loop.ports) {
    port.C += port.C_delayed;
    port.C_delayed.setZero();
  }
  loop.delay = 0.0;
  return loop;
}

/// True for one element whose every way around the loop passes the delay once: it may then stand anywhere on that way.
bool is_one_ring(const Loop& loop) {
  if (loop.elements.size() != 1) return false;
  const Loop undelayed = without_delay(loop);
  constexpr std::array<double, 3> angles{0.3, 0.7, 1.2};
  return std::ranges::all_of(angles, [&](double angle) {
    const auto s = std::polar(1.0 / loop.delay, angle);
    const auto H = loop.element_response(s)(0, 0), H0 = std::exp(-s * loop.delay) * undelayed.element_response(s)(0, 0);
    return std::abs(H - H0) <= 1e-9 * (std::abs(H) + std::abs(H0));
  });
}

/// Index of a relay in front of the plant that can take over the delay.
std::optional<std::size_t> relay_before_plant(const Loop& loop) {
  std::optional<std::size_t> relay;
  for (std::size_t i = 0; i < loop.ports.size(); ++i) {
    if (loop.ports[i].rubs && !loop.ports[i].opposes) return std::nullopt;
    if (loop.elements[i].as<Relay<double>>() == nullptr) continue;
    if (loop.ports[i].path == "loop.element" || is_one_ring(loop)) relay = i;
  }
  return relay;
}

TimeDomainLoop delay_relay(const Loop& from, std::size_t i) {
  Loop loop = without_delay(from);
  const auto& relay = law_of<Relay<double>>(from.elements[i]);
  DelayedRelay<double> delayed;
  delayed.level = relay.level;
  delayed.hysteresis = relay.hysteresis;
  delayed.dead_zone = relay.dead_zone;
  delayed.delay = from.delay;
  loop.elements[i] = delayed;
  make_rates(loop);
  return {std::move(loop), 0, 0};
}

const Sampled<double>* clock_at(const Loop& loop, std::size_t i) { return loop.elements[i].as<Sampled<double>>(); }

/// True if a sampled controller, or a part of one, reads the output of element j.
bool read_by_computers(const Loop& loop, std::size_t j) {
  for (std::size_t i = 0; i < loop.ports.size(); ++i)
    if (clock_at(loop, i) != nullptr && loop.ports[i].D(static_cast<Index>(j)) != 0.0) return true;
  return false;
}

/// True if something else does: the plant, or another element.
bool read_by_others(const Loop& loop, std::size_t j) {
  if (!loop.B.col(static_cast<Index>(j)).isZero(0.0)) return true;
  for (std::size_t i = 0; i < loop.ports.size(); ++i)
    if (clock_at(loop, i) == nullptr && loop.ports[i].D(static_cast<Index>(j)) != 0.0) return true;
  return false;
}

/// True if sampled controllers are all that reads past states, and read no present ones; their outputs to the rest are
/// not read by one another.
bool only_computers_read_late(const Loop& loop) {
  if (!loop.A_delayed.isZero(0.0)) return false;
  const std::size_t count = loop.elements.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Port& port = loop.ports[i];
    const bool reads_late = !port.C_delayed.isZero(0.0);
    if (clock_at(loop, i) == nullptr ? reads_late : !port.C.isZero(0.0)) return false;
  }
  for (std::size_t j = 0; j < count; ++j)
    if (clock_at(loop, j) != nullptr && read_by_computers(loop, j) && read_by_others(loop, j)) return false;
  return true;
}

/// The loop whose sampled controllers read without the dead time and put out behind it.
TimeDomainLoop read_ahead(const Loop& from) {
  Loop loop = without_delay(from);
  for (std::size_t i = 0; i < loop.elements.size(); ++i) {
    auto* sampled = loop.elements[i].as<Sampled<double>>();
    if (sampled == nullptr) continue;
    Port& port = loop.ports[i];
    port.C_v = port.C * loop.A;
    port.D_v = port.C * loop.B;
    port.c_v = port.C * loop.E;
    sampled->ahead = from.delay;
    sampled->leaves = read_by_computers(loop, i) ? 0.0 : 1.0;
  }
  return {std::move(loop), 0, 0};
}

/// All rows that read X(t - delay): those of the states, then those of the inputs.
MatrixXd delayed_rows(const Loop& loop) {
  const Index n = loop.states();
  MatrixXd rows(n + std::ssize(loop.ports), n);
  rows.topRows(n) = loop.A_delayed;
  for (Index i = 0; i < std::ssize(loop.ports); ++i)
    rows.row(n + i) = loop.ports[static_cast<std::size_t>(i)].C_delayed;
  return rows;
}

/// Orthonormal rows that span the given ones: the independent delayed signals.
MatrixXd independent_signals(MatrixXd rows) {
  for (auto row : rows.rowwise())
    if (const double size = row.norm(); size > 0.0) row /= size;
  const PivotedQr qr = pivoted_qr(rows.transpose(), 1e-13);
  return qr.Q.leftCols(qr.rank).transpose();
}

/// A block with zero rows appended.
MatrixXd stacked(const MatrixXd& top, Index below) {
  MatrixXd all = MatrixXd::Zero(top.rows() + below, top.cols());
  all.topRows(top.rows()) = top;
  return all;
}

/// The loop with one approximation of the delay for each row of `signals`, driven by that signal.
Loop with_pade(const Loop& from, const MatrixXd& signals, const StateSpace& pade) {
  const Index n = from.states(), m = pade.states(), more = signals.rows() * m;
  // Row of coefficients over the delayed signals -> row over [X | states of the approximations].
  const auto late = [&](const auto& rows) {
    const MatrixXd share = rows * signals.transpose();  // the signals are orthonormal
    MatrixXd wide = MatrixXd::Zero(share.rows(), n + more);
    wide.leftCols(n) = pade.D(0, 0) * share * signals;
    for (Index k = 0; k < signals.rows(); ++k) wide.middleCols(n + k * m, m) = share.col(k) * pade.C;
    return wide;
  };
  Loop loop = from;
  loop.A = stacked(late(from.A_delayed), more);
  loop.A.topLeftCorner(n, n) += from.A;
  for (Index k = 0; k < signals.rows(); ++k) {
    loop.A.block(n + k * m, 0, m, n) = pade.B * signals.row(k);
    loop.A.block(n + k * m, n + k * m, m, m) = pade.A;
  }
  loop.A_delayed = MatrixXd::Zero(n + more, n + more);
  loop.B = stacked(from.B, more);
  loop.E = stacked(from.E, more);
  if (from.origin.size() > 0) loop.origin = stacked(from.origin, more);
  if (from.origin_rate.size() > 0) loop.origin_rate = stacked(from.origin_rate, more);
  loop.C_y = stacked(from.C_y.transpose(), more).transpose();
  for (auto& port : loop.ports) {
    const Eigen::RowVectorXd now = stacked(port.C.transpose(), more).transpose();
    port.C = now + late(port.C_delayed).row(0);
    port.C_v = stacked(port.C_v.transpose(), more).transpose();
    port.C_delayed = Eigen::RowVectorXd::Zero(n + more);
  }
  if (from.own_states.size() > 0) {
    loop.own_states = MatrixXd::Identity(n + more, n + more);
    loop.own_states.topLeftCorner(n, n) = from.own_states;
  }
  for (Index i = 1; i <= more; ++i) loop.state_names.push_back("delay" + std::to_string(i));
  loop.delay = 0.0;
  make_rates(loop);
  return loop;
}

}  // namespace

StateSpace pade_delay(double delay, int order) {
  check_order(order);
  if (!(delay > 0.0) || !std::isfinite(delay))
    throw std::invalid_argument("delay = " + std::to_string(delay) + ": must be positive and finite");
  // Junction k passes on y_(k+1) = y_(k-1) - xi_k with d xi_k/dt = (a_k/delay) y_k, y_(m+1) = 0, and the signal is
  // r = y_0 + y_1, the delayed one y_0 - y_1. So y_k is the sum of xi_(k+1), xi_(k+3), ..., and where m - k is even
  // also r - sum of all xi. States: xi_k sqrt(2/a_k).
  const Index m = order;
  StateSpace pade{MatrixXd::Zero(m, m), MatrixXd::Zero(m, 1), MatrixXd::Zero(1, m),
                  MatrixXd::Constant(1, 1, m % 2 == 0 ? 1.0 : -1.0)};
  for (Index k = 1; k <= m; ++k) {
    const bool open = (m - k) % 2 == 0;
    for (Index j = 1; j <= m; ++j) {
      const double share = (j > k && (j - k) % 2 == 1 ? 1.0 : 0.0) - (open ? 1.0 : 0.0);
      pade.A(k - 1, j - 1) = share * std::sqrt(denominator(k) * denominator(j)) / delay;
    }
    if (!open) continue;
    pade.B(k - 1, 0) = std::sqrt(2.0 * denominator(k)) / delay;
    pade.C(0, k - 1) = -pade.D(0, 0) * std::sqrt(2.0 * denominator(k));
  }
  return pade;
}

double pade_error(double w, double delay, int order) {
  check_order(order);
  if (!(delay >= 0.0) || !std::isfinite(delay) || !std::isfinite(w))
    throw std::invalid_argument("w = " + std::to_string(w) + ", delay = " + std::to_string(delay) +
                                ": must be finite, delay >= 0");
  const double turn = w * delay;
  double g = 0.0;  // the tail of the continued fraction; infinite at a pole, which the next step handles
  for (Index k = order; k >= 1; --k) g = turn / (denominator(k) - turn * g);
  return 2.0 * std::abs(std::sin(0.5 * turn - std::atan(g)));
}

int pade_order_for(double w, double delay) {
  constexpr double accurate = 1e-9;
  int order = lowest_pade_order;
  while (order < highest_pade_order && pade_error(w, delay, order) > accurate) ++order;
  return order;
}

TimeDomainLoop in_time_domain(const Loop& loop, int pade_order) {
  if (loop.sampled) return in_time_domain(*loop.sampled, pade_order);
  if (!loop.measured.empty()) return in_time_domain(with_fits(loop), pade_order);
  if (!(loop.delay > 0.0)) return {loop, 0, 0};
  const MatrixXd rows = delayed_rows(loop);
  if (rows.isZero(0.0)) return {without_delay(loop), 0, 0};
  if (loop.continuous && only_computers_read_late(loop)) return read_ahead(loop);
  if (const auto relay = relay_before_plant(loop)) return delay_relay(loop, *relay);
  const StateSpace pade = pade_delay(loop.delay, pade_order);
  const MatrixXd signals = independent_signals(rows);
  return {with_pade(loop, signals, pade), pade_order, signals.rows() * pade.states()};
}

Eigen::VectorXd with_constant_history(const Loop& loop, const Eigen::VectorXd& X) {
  const Index n = X.size(), more = loop.states() - n;
  Eigen::VectorXd all(n + more);
  all.head(n) = X;
  if (more > 0)
    all.tail(more) = solve(MatrixXd(loop.A.bottomRightCorner(more, more)), -loop.A.bottomLeftCorner(more, n) * X);
  return all;
}

Eigen::VectorXd with_constant_history(const TimeDomainLoop& from, const Eigen::VectorXd& X) {
  const Index n = from.loop.states() - from.delay_states;
  if (X.size() != n)
    throw std::invalid_argument("history: " + std::to_string(X.size()) + " states given, the loop without delay has " +
                                std::to_string(n));
  return with_constant_history(from.loop, X);
}

}  // namespace limcycle
