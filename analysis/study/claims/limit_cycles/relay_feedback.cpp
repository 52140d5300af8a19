#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "limcycle/analysis/study/claims/limit_cycles/cycle_claims.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle::cycle_claims {
namespace {

Eigen::VectorXd mirrored_state(const RelayFeedback& relay, double h) {
  const auto [Phi, Gamma] = relay.over(h);
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(Phi.rows(), Phi.cols());
  return solve(Eigen::MatrixXd(I + Phi), Gamma) * relay.level;
}

/// C x at a time after the switch to +level.
double output_after(const RelayFeedback& relay, const Eigen::VectorXd& switching, double t) {
  const auto [Phi, Gamma] = relay.over(t);
  return relay.C.dot((Gamma * relay.level - Phi * switching).transpose());
}

/// The largest |C x| of the half period: the best of a grid, then golden sections around it.
double peak(const RelayFeedback& relay, const Eigen::VectorXd& switching, double half_period) {
  constexpr int points = 64;
  const auto size = [&](double t) { return std::abs(output_after(relay, switching, t)); };
  int best = 0;
  for (int i = 0; i <= points; ++i)
    if (size(half_period * i / points) > size(half_period * best / points)) best = i;
  double low = half_period * std::max(best - 1, 0) / points, high = half_period * std::min(best + 1, points) / points;
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  for (int i = 0; i < 50; ++i) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    (size(a) > size(b) ? high : low) = size(a) > size(b) ? b : a;
  }
  return size(0.5 * (low + high));
}

/// True if the relay keeps its side for the whole half period. Just after the switch C x is -hysteresis and may only
/// fall.
bool keeps_its_side(const RelayFeedback& relay, const Eigen::VectorXd& switching, double half_period) {
  constexpr int points = 256;
  const double scale = 1e-9 * (std::abs(relay.hysteresis) + relay.C.cwiseAbs().dot(switching.cwiseAbs().transpose()));
  for (int i = 1; i < points; ++i)
    if (output_after(relay, switching, half_period * i / points) > relay.hysteresis + scale) return false;
  return true;
}

}  // namespace

std::pair<Eigen::MatrixXd, Eigen::VectorXd> RelayFeedback::over(double h) const {
  const Eigen::Index n = A.rows();
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n + 1, n + 1);
  M.topLeftCorner(n, n) = A * h;
  M.topRightCorner(n, 1) = B * h;
  const Eigen::MatrixXd E = exponential(M);
  return {E.topLeftCorner(n, n), E.topRightCorner(n, 1)};
}

RelayFeedback relay_feedback(const Loop& loop, double level, double hysteresis) {
  const Port& port = loop.ports.front();
  if (port.rubs) return {loop.A, -loop.B.col(0), port.C_v, level, hysteresis};  // B contains the sign of friction
  return {loop.A, loop.B.col(0), loop.C_y, level, hysteresis};
}

double switching_output(const RelayFeedback& relay, double h) {
  return relay.C.dot(mirrored_state(relay, h).transpose());
}

std::vector<RelayCycle> relay_cycles(const RelayFeedback& relay, double shortest, double longest,
                                     const SwitchingOutput& output) {
  std::vector<RelayCycle> cycles;
  const auto excess = [&](double h) { return output(relay, h) - relay.hysteresis; };
  for (const double h : zeros_on_grid(excess, shortest, longest, 400)) {
    RelayCycle cycle;
    cycle.half_period = h;
    cycle.switching = mirrored_state(relay, h);
    if (!keeps_its_side(relay, cycle.switching, h)) continue;
    const auto [Phi, Gamma] = relay.over(h);
    const Eigen::VectorXd w = relay.A * cycle.switching + relay.B * relay.level;
    const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(Phi.rows(), Phi.cols());
    cycle.W = (I - w * relay.C / relay.C.dot(w.transpose())) * Phi;
    const Eigen::VectorXcd values = eigenvalues(cycle.W);
    cycle.eigenvalues.assign(values.begin(), values.end());
    std::ranges::sort(cycle.eigenvalues, std::greater{}, [](const auto& z) { return std::abs(z); });
    cycle.peak = peak(relay, cycle.switching, h);
    cycles.push_back(std::move(cycle));
  }
  return cycles;
}

}  // namespace limcycle::cycle_claims
