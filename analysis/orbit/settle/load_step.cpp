#include "limcycle/analysis/orbit/settle/load_step.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "limcycle/analysis/motion/time_scales.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/motion/working_loop.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"

namespace limcycle {
namespace {

constexpr double levels = 2.0;      ///< load, relative to the level of the friction
constexpr double rest_rate = 1e-6;  ///< rates at rest, in typical sizes per slowest time constant
constexpr double same_direction = 1e-6;

/// The state X of a loop with the body at rest: in coordinates that mix positions and velocities, its velocity is zero
/// only up to rounding, and must not count as sliding.
LoopState at_rest(const Loop& loop, const Eigen::VectorXd& X) {
  LoopState state = without_history(loop, X);
  const Port& port = loop.ports.back();
  const double v = (port.C_v * X + port.c_v * loop.external).value();
  if (std::abs(v) > rest_rate * typical_rubbing_velocity(loop)) return state;
  if (const auto stuck = loop.elements.back().facts().stuck) state.modes.back() = *stuck;
  return state;
}

/// Largest rate at this state, in typical sizes per slowest time constant; infinite if an element leaves its mode at
/// once, such as stiction that the load exceeds.
double largest_rate(const Loop& loop, const LoopState& state, const State& sizes) {
  LoopField field(loop);
  field.modes() = state.modes;
  State dx;
  field.rate(state.x, dx, 0.0);
  std::vector<double> guards;
  field.guards(state.x, 0.0, guards);
  if (std::ranges::any_of(guards, [](double guard) { return guard < 0.0; })) return infinite;
  const double slow = slow_time(loop);
  double largest = 0.0;
  for (std::size_t i = 0; i < dx.size(); ++i) largest = std::max(largest, std::abs(dx[i]) * slow / sizes[i]);
  return largest;
}

/// True if the difference of both states is rounding, compared with their distance from the point of rest.
bool same(const LoopState& one, const LoopState& other, const Eigen::VectorXd& rest, const State& sizes) {
  double apart = 0.0, away = 0.0;
  for (Eigen::Index i = 0; i < rest.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    apart = std::max(apart, std::abs(one.x[k] - other.x[k]) / sizes[k]);
    away = std::max(away, std::abs(one.x[k] - rest(i)) / sizes[k]);
  }
  return apart <= same_direction * away;
}

}  // namespace

std::optional<LoadStep> load_step(const Loop& loop) {
  if (!loop.ports.back().rubs) return std::nullopt;
  const double load = levels * output_level(loop, loop.elements.size() - 1);
  Loop loaded = loop;
  loaded.external(external_force) += load;
  Loop linear = loaded;
  linear.A = working_loop(loop) - loop.A_delayed;
  bool exact = false;
  const Eigen::VectorXd rest = loop.rest_point(exact), held = linear.rest_point(exact);
  const LoadStep step{load, without_history(loop, held)};
  const State sizes = typical_sizes(loop);
  if (!(largest_rate(loaded, at_rest(loaded, held), sizes) <= rest_rate)) return std::nullopt;
  if (same(step.start, displaced(loop, (loop.C_y * (held - rest)).value()), rest, sizes)) return std::nullopt;
  return step;
}

}  // namespace limcycle
