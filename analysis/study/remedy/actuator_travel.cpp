#include "limcycle/analysis/study/remedy/actuator_travel.hpp"

#include <cmath>
#include <utility>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/models/diagram/assemble.hpp"

namespace limcycle {
namespace {

constexpr double rtol_of_travel = 1e-6;
constexpr long most_travel_steps = 1'000'000;

}  // namespace

std::optional<double> actuator_travel(const LoopParts& parts, double step, double duration) {
  const auto row = command_row(parts);
  if (!row) return std::nullopt;
  const Loop loop = build_loop(parts);
  LoopField field(loop);
  const LoopState from = displaced(loop, step);
  field.modes() = from.modes;
  State rates;
  const auto command = [&](const State& x, double t) {
    field.rate(x, rates, t);
    double sum = row->external.dot(field.external().transpose());
    for (Eigen::Index i = 0; i < row->states.size(); ++i) sum += row->states(i) * x[static_cast<std::size_t>(i)];
    for (Eigen::Index i = 0; i < row->outputs.size(); ++i)
      if (row->outputs(i) != 0.0) sum += row->outputs(i) * field.output(static_cast<std::size_t>(i));
    return sum;
  };
  rates.resize(field.size());
  March march(field, StepperKind::automatic, loop_weights(loop, rtol_of_travel));
  march.begin(from.x, 0.0);
  double travel = 0.0, before = command(from.x, 0.0);
  State between;
  while (march.t() < duration) {
    const std::vector<Mode> modes = field.modes();
    if (march.steps() > most_travel_steps || march.step(duration) != Status::converged) return std::nullopt;
    const auto go_to = [&](double now) {
      travel += std::abs(now - before);
      before = now;
    };
    const std::vector<Mode> after = std::exchange(field.modes(), modes);
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      march.last().interpolate(share, between);
      go_to(command(between, march.last().t0 + share * (march.last().t1 - march.last().t0)));
    }
    field.modes() = after;
    go_to(command(march.x(), march.t()));
  }
  return std::isfinite(travel) ? std::optional(travel) : std::nullopt;
}

}  // namespace limcycle
