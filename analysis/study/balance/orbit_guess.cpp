#include "limcycle/analysis/study/balance/orbit_guess.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <complex>
#include <numbers>

#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;

}  // namespace

OrbitGuess guess_orbit(const Loop& loop, const std::function<Eigen::VectorXd(double phase)>& linear_states,
                       double frequency, bool half, int nodes) {
  using std::numbers::pi;
  OrbitGuess guess{{}, 2.0 * pi / frequency, half};
  const double span = half ? pi : 2.0 * pi;
  LoopField field(loop);
  const bool remembers = field.size() > static_cast<std::size_t>(loop.states());
  LoopState state{State(field.size(), 0.0), std::vector<Mode>(loop.elements.size())};
  // Nodes avoid the phases 0 and pi/2, where relays and friction switch.
  for (int k = -2 * nodes; k < nodes; ++k) {
    Eigen::Map<Eigen::VectorXd>(state.x.data(), loop.states()) = linear_states(span * (k + 0.37) / nodes);
    field.modes() = state.modes;
    if (!remembers || k == -2 * nodes) field.start(state.x, 0.0);
    state.modes = field.modes();
    if (k >= 0) guess.nodes.push_back(state);
    March march(field, StepperKind::automatic, loop_weights(loop, 1e-7));
    march.begin(state.x, 0.0);
    const double duration = span / nodes / frequency;
    while (march.t() < duration && march.steps() < 20000)
      if (march.step(duration) != Status::converged) break;
    std::ranges::copy(march.x().begin() + loop.states(), march.x().end(), state.x.begin() + loop.states());
    state.modes = field.modes();
  }
  return guess;
}

Eigen::VectorXd linear_states(const Loop& loop, const HarmonicBalance& balance, double phase, double late) {
  const Eigen::Index n = loop.states();
  const auto output = [&](int order) {
    Eigen::VectorXcd W(std::ssize(balance.outputs));
    for (std::size_t k = 0; k < balance.outputs.size(); ++k)
      W(static_cast<Eigen::Index>(k)) = balance.outputs[k](order);
    return W;
  };
  const Eigen::VectorXd pull = loop.E * loop.external + loop.B * output(0).imag();
  Eigen::VectorXd x = least_squares(loop.A, -pull);
  for (int order = 1; order <= balance.harmonics; ++order) {
    const Complex s(0.0, order * balance.frequency);
    const Eigen::MatrixXcd M = s * Eigen::MatrixXcd::Identity(n, n) - loop.A.cast<Complex>();
    const Complex turn = std::polar(1.0, order * phase) * std::exp(-s * late);
    x += (solve(M, loop.B.cast<Complex>() * output(order)) * turn).imag();
  }
  return x;
}

}  // namespace limcycle
