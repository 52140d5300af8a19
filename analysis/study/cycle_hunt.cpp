#include "limcycle/analysis/study/cycle_hunt.hpp"

#include <algorithm>

#include "limcycle/analysis/motion/stepper_limits.hpp"
#include "limcycle/analysis/orbit/edge.hpp"
#include "limcycle/analysis/study/output_per_input.hpp"
#include "limcycle/analysis/study/verdicts.hpp"

namespace limcycle {

CycleHunt::CycleHunt(const Loop& loop, const PredictOptions& options, const SearchBox& box) : loop_(loop) {
  const double unit = output_per_input(loop);
  settle_.amplitude_floor = unit * box.amplitude_min;
  settle_.amplitude_ceiling = 1e4 * unit * box.amplitude_max;
  settle_.rtol = std::clamp(0.1 * loosest_stiff_tolerance(loop), 1e-12, settle_.rtol);
  settle_.shooting.accuracy = options.accuracy;
  settle_.shooting.rtol = std::clamp(options.accuracy, 1e-13, 1e-8);
  settle_.shooting.tolerance = 0.1 * settle_.shooting.rtol;
  settle_.shooting.derivative_rtol = std::clamp(options.accuracy, 1e-10, 1e-8);
  settle_.stop = settle_.shooting.stop = options.stop;
}

const OutcomeOfStart& CycleHunt::settle_from(const LoopState& start, std::string name) {
  settle_.known = cycles_;
  Settled settled = settle(loop_, start, settle_);
  OutcomeOfStart outcome{std::move(name),          settled.outcome, std::move(settled.why), {},
                         std::move(settled.trace), settled.time,    settled.steps};
  outcome.cycle = settled.known;
  outcome.by = std::move(settled.by);
  outcome.half_range = settled.half_range;
  outcome.mean_period = settled.mean_period;
  if (settled.shot) {
    maps_ += settled.shot->maps;
    outcome.cycle = merge(cycles_, settled.shot->cycle);
  }
  outcomes_.push_back(std::move(outcome));
  return outcomes_.back();
}

std::optional<std::size_t> CycleHunt::keep(const ShootingResult& shot) {
  maps_ += shot.maps;
  if (shot.status != Status::converged || !shot.cycle.stable) return std::nullopt;
  if (shot.cycle.amplitude < settle_.amplitude_floor) return std::nullopt;
  return merge(cycles_, shot.cycle);
}

std::optional<std::size_t> CycleHunt::shoot_from(const OrbitGuess& guess) {
  ShootingOptions options = settle_.shooting;
  options.max_maps = 60;
  return keep(shoot_multiple(loop_, guess, options));
}

std::optional<std::size_t> CycleHunt::edge_along(const std::function<LoopState(double scale)>& ray, double period) {
  settle_.known = cycles_;
  // Where small and large oscillations come to the same in the end there is no border between them.
  const Settled small = settle(loop_, ray(smallest_edge_scale), settle_),
                large = settle(loop_, ray(largest_edge_scale), settle_);
  const bool same = small.outcome == large.outcome && small.outcome != Outcome::undecided && small.known == large.known;
  if (same && !small.shot && !large.shot) return std::nullopt;
  for (const Settled* end : {&small, &large})
    if (end->shot) merge(cycles_, end->shot->cycle);
  settle_.known = cycles_;
  return keep(edge_cycle(loop_, ray, period, settle_));
}

}  // namespace limcycle
