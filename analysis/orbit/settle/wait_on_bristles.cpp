#include "limcycle/analysis/orbit/settle/wait_on_bristles.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/sampling.hpp"
#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"

namespace limcycle {
namespace {

constexpr double nearly_all = 0.98;  ///< of the typical force: beyond, the body creeps ever faster
constexpr double relieved = 0.05;    ///< fall of the force, in the same unit, that shows that the body broke away

/// Copies the bristles of the element at the same place of the other loop.
void carry_bristles(const LoopField& from, const LoopState& state, std::size_t rubs, const LoopField& to,
                    std::size_t place, LoopState& into) {
  const auto begin = state.x.begin() + static_cast<std::ptrdiff_t>(from.first_state(rubs));
  std::copy_n(begin, from.loop().elements[rubs].states(),
              into.x.begin() + static_cast<std::ptrdiff_t>(to.first_state(place)));
  into.modes[place] = state.modes[rubs];
}

/// The place in the other loop of the element that stands there in this one.
std::optional<std::size_t> place_of(const Port& port, const Loop& other) {
  const auto found = std::ranges::find(other.ports, port.path, &Port::path);
  if (found == other.ports.end()) return std::nullopt;
  return static_cast<std::size_t>(found - other.ports.begin());
}

}  // namespace

std::optional<WaitOnBristles> wait_on_bristles(const Loop& loop, const LoopState& here, std::size_t rubs, double rtol,
                                               long most_steps, const std::function<bool()>& stop) {
  const Loop& twin = *loop.continuous;
  const auto place = place_of(loop.ports[rubs], twin);
  if (!place || twin.delay > 0.0) return std::nullopt;
  LoopField field(twin);
  const LoopField sampled(loop);
  LoopState state = without_history(twin, continuous_state(loop, here));
  carry_bristles(sampled, here, rubs, field, *place, state);
  field.modes() = state.modes;
  March march(field, StepperKind::automatic, loop_weights(twin, rtol));
  StillnessWatch stillness(twin, typical_sizes(twin), slow_time(twin), rtol);
  march.begin(state.x, 0.0);

  const double size = twin.elements[*place].scales().output;
  double largest = 0.0;
  WaitOnBristles wait;
  std::optional<LoopState> before;
  State dx;
  while (march.steps() < most_steps && !(stop && stop()) && march.step(1e15) == Status::converged) {
    field.rate(march.x(), dx, march.t());
    const double force = std::abs(field.output(*place));
    wait.steps = march.steps();
    if (force < nearly_all * size && force >= largest) {
      wait.time = march.t();
      before = LoopState{march.x(), field.modes()};
    }
    largest = std::max(largest, force);
    if (force < largest - relieved * size) {
      if (!before) return std::nullopt;
      const Eigen::Map<const Eigen::VectorXd> X(before->x.data(), twin.states());
      wait.resume = sampled_state(loop, X);
      carry_bristles(field, *before, *place, sampled, rubs, *wait.resume);
      return wait;
    }
    wait.still = stillness.look(march.t(), march.x(), dx, field.modes());
    if (!wait.still && march.last().switched) wait.still = stillness.switched(march.t(), march.x(), dx);
    if (!wait.still) continue;
    wait.time = march.t();
    return wait;
  }
  return std::nullopt;
}

}  // namespace limcycle
