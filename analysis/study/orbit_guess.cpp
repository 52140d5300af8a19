#include "limcycle/analysis/study/orbit_guess.hpp"

#include <algorithm>
#include <numbers>

#include "limcycle/analysis/motion/tolerances.hpp"

namespace limcycle {

OrbitGuess guess_orbit(const Loop& loop, const std::function<Eigen::VectorXd(double phase)>& linear_states,
                       double frequency, bool half, int nodes) {
  using std::numbers::pi;
  OrbitGuess guess{{}, 2.0 * pi / frequency, half};
  const double span = half ? pi : 2.0 * pi;
  LoopField field(loop);
  const bool remembers = field.size() > static_cast<std::size_t>(loop.states());
  LoopState state{State(field.size(), 0.0), std::vector<Mode>(loop.elements.size())};
  // Nodes keep off the phases 0 and pi/2, where relays and friction switch.
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

}  // namespace limcycle
