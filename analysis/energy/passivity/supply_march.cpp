#include "limcycle/analysis/energy/passivity/supply_march.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limcycle/analysis/motion/steppers/controlled_rodas5p.hpp"

namespace limcycle {
namespace {

constexpr int most_switches_at_once = 200;
constexpr long most_steps = 20'000;

ErrorWeights weights_of(const Element& element, double rtol) {
  ErrorWeights weights{rtol, {}};
  for (int i = 0; i < element.states(); ++i) weights.atol.push_back(0.1 * rtol * element.state_scale(i));
  const Scales scales = element.scales();
  const double way = scales.displacement < infinite ? scales.displacement : 1.0;
  weights.atol.push_back(1e-4 * rtol * scales.output * way);
  return weights;
}

double signal_at(const SignalPiece& piece, double t) {
  if (piece.from == piece.to) return piece.from;
  return piece.from + (piece.to - piece.from) * (t / piece.duration);
}
double slope_of(const SignalPiece& piece) { return (piece.to - piece.from) / piece.duration; }

}  // namespace

DrivenBy port_of(const Element& element) {
  return element.is_friction() || element.facts().acts_on_rate ? DrivenBy::velocity : DrivenBy::input;
}

std::vector<SignalPiece> pieces_of(const VelocityCycle& cycle) {
  std::vector<SignalPiece> pieces;
  for (std::size_t k = 0; k + 1 < cycle.time.size(); ++k)
    if (const double duration = cycle.time[k + 1] - cycle.time[k]; duration > 0.0)
      pieces.push_back({duration, cycle.velocity[k], cycle.velocity[k + 1]});
  return pieces;
}

VelocityCycle cycle_of(std::span<const SignalPiece> pieces) {
  VelocityCycle cycle;
  double t = 0.0;
  for (const SignalPiece& piece : pieces) {
    if (cycle.velocity.empty() || cycle.velocity.back() != piece.from) {
      cycle.time.push_back(t);
      cycle.velocity.push_back(piece.from);
    }
    cycle.time.push_back(t += piece.duration);
    cycle.velocity.push_back(piece.to);
  }
  return cycle;
}

SupplyMarch::SupplyMarch(const Element& element, double rtol)
    : element_(element),
      port_(port_of(element)),
      slopes_(element),
      stepper_(std::make_unique<ControlledRodas5p>(weights_of(element, rtol))) {}

SupplyMarch::~SupplyMarch() = default;

Input<double> SupplyMarch::input(const SignalPiece& piece, double t, double x) const {
  const double value = signal_at(piece, t), slope = slope_of(piece);
  const double heading = slope != 0.0 ? slope : value;  // a constant velocity counts as accelerating
  const double drive = heading < 0.0 ? -infinite : infinite;
  if (port_ == DrivenBy::input) return {value, slope, drive};
  return {x + 0.5 * (piece.from + value) * t, value, drive};
}

ElementPoint SupplyMarch::virgin(const SignalPiece& first) const {
  ElementPoint at{std::vector<double>(static_cast<std::size_t>(element_.states()), 0.0), {}, 0.0, first.from};
  if (element_.has_modes()) at.mode = element_.start(input(first, 0.0, 0.0), at.z);
  return at;
}

/// The first guard that is negative; -1: none.
int SupplyMarch::fired(const Input<double>& in, const ElementPoint& at) const {
  if (!element_.has_modes()) return -1;
  std::vector<double> guards(static_cast<std::size_t>(element_.guards(at.mode)));
  element_.guard(in, at.mode, at.z, guards);
  const auto first = std::ranges::find_if(guards, [](double g) { return g < 0.0; });
  return first == guards.end() ? -1 : static_cast<int>(first - guards.begin());
}

bool SupplyMarch::settle_at(const Input<double>& in, ElementPoint& at) const {
  for (int k = 0; k < most_switches_at_once; ++k) {
    const int guard = fired(in, at);
    if (guard < 0) return true;
    at.mode = element_.next(in, at.mode, at.z, guard);
  }
  return false;
}

bool SupplyMarch::settle(const SignalPiece& piece, ElementPoint& at) const {
  Input<double> in = input(piece, 0.0, at.x);
  if (piece.from != at.signal && element_.needs_drive()) {
    const double turned = in.drive;
    in.drive = piece.from < at.signal ? -infinite : infinite;
    if (!settle_at(in, at)) return false;
    in.drive = turned;
  }
  at.signal = piece.from;
  return settle_at(in, at);
}

Status SupplyMarch::cross(const SignalPiece& piece, ElementPoint& at) {
  if (piece.from * piece.to < 0.0) {  // laws without modes have their kink at zero
    const double share = piece.from / (piece.from - piece.to);
    const SignalPiece before{share * piece.duration, piece.from, 0.0};
    const SignalPiece after{(1.0 - share) * piece.duration, 0.0, piece.to};
    if (const Status status = cross_smooth(before, at); status != Status::converged) return status;
    return cross_smooth(after, at);
  }
  return cross_smooth(piece, at);
}

double SupplyMarch::first_step(const SignalPiece& piece, const ElementPoint& at) const {
  double h = piece.duration;
  std::vector<double> dz(at.z.size());
  const double probe = 1e-6 * piece.duration;
  element_.rate(input(piece, probe, at.x), at.mode, at.z, dz);
  for (std::size_t i = 0; i < dz.size(); ++i)
    if (dz[i] != 0.0) h = std::min(h, 0.02 * element_.state_scale(static_cast<int>(i)) / std::abs(dz[i]));
  return std::max(h, 1e-12 * piece.duration);
}

/// The present piece as a system for the stepper: the states, then the energy supplied.
struct SupplyMarch::Field {
  SupplyMarch& march;
  const SignalPiece& piece;
  const ElementPoint& at;  ///< its mode is that of the step; its states are not used
  double x0;

  Input<double> input(double t) const { return march.input(piece, t, x0); }
  static std::span<const double> states(const State& x) { return std::span(x).first(x.size() - 1); }

  void rate(const State& x, State& dx, double t) const {
    const Input<double> in = input(t);
    march.element_.rate(in, at.mode, states(x), std::span(dx).first(dx.size() - 1));
    dx.back() = signal_at(piece, t) * march.element_.output(in, at.mode, states(x));
  }
  void jacobian(const State& x, Eigen::MatrixXd& J, double t, State& dfdt) const {
    const Input<double> in = input(t);
    const double signal = signal_at(piece, t), slope = slope_of(piece);
    const auto& table = march.slopes_.response(in, at.mode, x.data());
    const bool velocity = march.port_ == DrivenBy::velocity;
    const double by_x = velocity ? signal : slope, by_v = velocity ? slope : 0.0;
    const Eigen::Index n = march.slopes_.states();
    for (Eigen::Index row = 0; row <= n; ++row) {
      const Eigen::Index from = row == n ? 0 : row + 1;
      const double factor = row == n ? signal : 1.0;
      J.row(row).head(n) = factor * table.row(from).segment(2, n);
      dfdt[static_cast<std::size_t>(row)] = factor * (table(from, 0) * by_x + table(from, 1) * by_v);
    }
    dfdt.back() += slope * march.element_.output(in, at.mode, states(x));
  }
  auto system() const {
    return std::make_pair(
        [this](const State& x, State& dx, double t) { rate(x, dx, t); },
        [this](const State& x, Eigen::MatrixXd& J, double t, State& dfdt) { jacobian(x, J, t, dfdt); });
  }
  /// The least of the guards at time t with the states x; `which` is its number.
  double least_guard(double t, const State& x, int& which) const {
    which = -1;
    if (!march.element_.has_modes()) return infinite;
    std::vector<double>& guards = march.guards_;
    guards.assign(static_cast<std::size_t>(march.element_.guards(at.mode)), 0.0);
    march.element_.guard(input(t), at.mode, states(x), guards);
    if (guards.empty()) return infinite;
    const auto least = std::ranges::min_element(guards);
    which = static_cast<int>(least - guards.begin());
    return *least;
  }
};

/// Length of the step after which the first guard has just turned negative, as it has after h; end_ is then the state.
/// Regula falsi (Illinois), except at a guard that rests at zero, which has no root, and where it is slow.
double SupplyMarch::locate(const Field& field, double h, int& which) {
  const double t0 = stepper_->stepper().start_time();
  int none = -1, side = 0;
  double low = 0.0, high = h, g_low = field.least_guard(t0, x_, none), g_high = field.least_guard(t0 + h, end_, which);
  for (int k = 0; k < 120 && high - low > 4e-16 * (t0 + high); ++k) {
    const bool aims = g_low > 0.0 && k < 12;
    double middle = aims ? (low * g_high - high * g_low) / (g_high - g_low) : 0.5 * (low + high);
    if (!(middle > low && middle < high)) middle = 0.5 * (low + high);
    if (!(middle > low && middle < high)) break;
    stepper_->stepper().repeat_step(field.system(), trial_, middle, error_);
    int here = -1;
    const double g = field.least_guard(t0 + middle, trial_, here);
    if (g < 0.0) {
      high = middle, g_high = g, which = here;
      end_ = trial_;
      if (side == -1) g_low *= 0.5;
      side = -1;
    } else {
      low = middle, g_low = g;
      if (side == 1) g_high *= 0.5;
      side = 1;
    }
  }
  return high;
}

/// One step from x_ to end_, not beyond the piece or the first switch, whose guard is `fired`, else -1.
Status SupplyMarch::step(const Field& field, double& t, double& h, int& fired) {
  const double start = t, rest = field.piece.duration - t;
  double dt = h >= rest * (1.0 - 1e-12) ? rest : h, tried = dt;
  for (int failures = 0; stepper_->try_step(field.system(), x_, t, end_, dt) != ControlledRodas5p::Result::success;) {
    tried = dt;
    if (++failures > 200 || t + dt == t)
      return std::isfinite(stepper_->last_error()) ? Status::stalled : Status::not_finite;
  }
  h = dt;
  if (tried == rest) t = field.piece.duration;
  if (field.least_guard(t, end_, fired) < 0.0)
    t = start + locate(field, tried, fired);
  else
    fired = -1;
  return Status::converged;
}

Status SupplyMarch::cross_smooth(const SignalPiece& piece, ElementPoint& at) {
  if (!(piece.duration > 0.0)) return Status::converged;
  if (!settle(piece, at)) return Status::chattering;
  const Field field{*this, piece, at, at.x};
  x_.assign(at.z.begin(), at.z.end());
  x_.push_back(0.0);
  const double before = supplied_;
  double t = 0.0, h = first_step(piece, at), last_switch = -infinite;
  int at_once = 0;
  stepper_->reset();
  for (long steps = 0; t < piece.duration; ++steps) {
    if (steps > most_steps) return Status::max_iterations;
    int fired = -1;
    if (const Status status = step(field, t, h, fired); status != Status::converged) return status;
    turnover_ += std::abs(end_.back() - x_.back());
    x_ = end_;
    supplied_ = before + x_.back();
    std::copy_n(x_.begin(), at.z.size(), at.z.begin());
    at.signal = signal_at(piece, t);
    const Input<double> in = field.input(t);
    if (watch) watch(in, at, supplied_);
    if (fired < 0) continue;
    at_once = t > last_switch + 1e-13 * piece.duration ? 0 : at_once + 1;
    last_switch = t;
    at.mode = element_.next(in, at.mode, at.z, fired);
    if (at_once > most_switches_at_once || !settle_at(in, at)) return Status::chattering;
    std::ranges::copy(at.z, x_.begin());
    stepper_->reset();
    if (watch) watch(in, at, supplied_);
    h = first_step({piece.duration, at.signal, piece.to}, at);
  }
  if (port_ == DrivenBy::velocity) at.x += 0.5 * (piece.from + piece.to) * piece.duration;
  return Status::converged;
}

CycleSupply periodic_supply(SupplyMarch& march, std::span<const SignalPiece> pieces, int most_cycles, double repeats) {
  CycleSupply result;
  const Element& element = march.element();
  ElementPoint at = march.virgin(pieces.front());
  double total = 0.0;
  for (int cycle = 0; cycle < most_cycles; ++cycle) {
    if (!march.settle(pieces.front(), at)) {
      result.status = Status::chattering;
      return result;
    }
    result.begin = at;
    march.restart();
    for (const SignalPiece& piece : pieces)
      if (const Status status = march.cross(piece, at); status != Status::converged) {
        result.status = status;
        return result;
      }
    result.supplied = march.supplied();
    result.turnover = march.turnover();
    result.total.push_back(total += march.supplied());
    ElementPoint again = at;
    if (!march.settle(pieces.front(), again)) continue;
    bool same = again.mode == result.begin.mode;
    for (std::size_t i = 0; same && i < again.z.size(); ++i)
      same = std::abs(again.z[i] - result.begin.z[i]) <= repeats * element.state_scale(static_cast<int>(i));
    if (same) {
      result.status = Status::converged;
      return result;
    }
  }
  return result;
}

}  // namespace limcycle
