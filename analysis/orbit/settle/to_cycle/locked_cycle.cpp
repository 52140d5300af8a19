#include "limcycle/analysis/orbit/settle/to_cycle/locked_cycle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/motion/sampling.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/orbit/cycle/measure.hpp"

namespace limcycle {
namespace {

/// The state after that time; nothing if the run ends early.
std::optional<LoopState> moved_on(const Loop& loop, const LoopState& from, double time, StepperKind kind,
                                  const SettleOptions& options, long& steps) {
  LoopField field(loop);
  field.modes() = from.modes;
  March march(field, kind, loop_weights(loop, options.rtol));
  march.begin(from.x, 0.0);
  bool ends = false;
  while (march.t() < time && !ends) ends = (options.stop && options.stop()) || march.step(time) != Status::converged;
  steps += march.steps();
  return ends ? std::nullopt : std::optional(LoopState{march.x(), field.modes()});
}

/// In typical sizes of the states; infinite between different modes.
double distance_between(const Loop& loop, const LoopState& one, const LoopState& other) {
  const State sizes = typical_sizes(loop);
  double largest = one.modes == other.modes ? 0.0 : infinite;
  for (std::size_t i = 0; i < sizes.size(); ++i)
    largest = std::max(largest, std::abs(one.x[i] - other.x[i]) / sizes[i]);
  return largest;
}

}  // namespace

std::optional<ShootingResult> locked_cycle(const Loop& loop, const LoopState& here, double samples, StepperKind kind,
                                           const SettleOptions& options, long& steps) {
  constexpr int many = 8;
  constexpr double longest = 1e6;    // samples
  constexpr double between = 0.371;  // of two samples: at one of them a rounding would decide on which side it is
  if (!(samples > 0.0) || samples * many > longest) return std::nullopt;
  const bool exact = kind == StepperKind::exact;
  const double sample = repetition_time(loop), period = samples * sample, allowed = exact ? 1e-9 : 10.0 * options.rtol;
  const auto after = [&](const LoopState& from, double time) {
    return moved_on(loop, from, time, kind, options, steps);
  };
  const auto first = after(here, between * sample);
  const auto next = first ? after(*first, period) : std::nullopt;
  const double once = next ? distance_between(loop, *next, *first) : infinite;
  if (!(once <= allowed)) return std::nullopt;
  const auto last = after(*first, many * period);
  if (!last || !(distance_between(loop, *last, *first) <= std::max(2.0 * once, 1e-9))) return std::nullopt;
  ShootingResult shot;
  shot.cycle.period = period;
  shot.cycle.start = *first;
  shot.cycle.method = "simulation";
  shot.cycle.stable = true;
  shot.cycle.residual = once;
  shot.cycle.error = std::max(once, exact ? 1e-9 : options.rtol);
  shot.status = record(loop, *first, period, options.rtol, 100, shot.cycle.trace);
  if (shot.status != Status::converged) return std::nullopt;
  measure(loop, shot.cycle);
  return shot;
}

}  // namespace limcycle
