#include "limcycle/analysis/study/predict/cycle_hunt.hpp"

#include <algorithm>
#include <utility>

#include "limcycle/analysis/orbit/settle/edge.hpp"
#include "limcycle/analysis/study/predict/cycle_search.hpp"
#include "limcycle/analysis/study/predict/verdicts.hpp"

namespace limcycle {
namespace {

constexpr long steps_of_a_guess = 20'000;  ///< of Newton's method from a guess; those that converge take up to 4'000
constexpr long steps_of_a_trend = 6'000;   ///< of one of the fifty motions along a border

}  // namespace

CycleHunt::CycleHunt(const Loop& loop, const PredictOptions& options, const SearchBox& box)
    : loop_(loop), settle_(cycle_search(loop, box, options.accuracy, options.stop)) {
  settle_.max_readings = options.max_readings;
}

OutcomeOfStart CycleHunt::simulate(const LoopState& start, std::string name) {
  settle_.known = cycles_;
  settle_.known_irregular = irregular_;
  Settled settled = settle(loop_, start, settle_);
  if (settled.outcome == Outcome::irregular) irregular_.push_back(settled.irregular);
  OutcomeOfStart outcome{std::move(name),          settled.outcome, std::move(settled.why), {},
                         std::move(settled.trace), settled.time,    settled.steps};
  outcome.cycle = settled.known;
  steps_ += settled.work;
  outcome.by = std::move(settled.by);
  outcome.irregular = settled.irregular;
  if (settled.shot) {
    maps_ += settled.shot->maps;
    outcome.cycle = merge(cycles_, settled.shot->cycle);
  }
  for (const Cycle& cycle : settled.passed)
    if (cycle.amplitude >= settle_.amplitude_floor) merge(cycles_, cycle);
  return outcome;
}

const OutcomeOfStart& CycleHunt::settle_from(const LoopState& start, std::string name) {
  outcomes_.push_back(simulate(start, std::move(name)));
  return outcomes_.back();
}

bool CycleHunt::is_news(const OutcomeOfStart& outcome) const {
  if (outcome.outcome == Outcome::undecided) return false;
  return std::ranges::none_of(outcomes_, [&](const OutcomeOfStart& one) {
    return one.outcome == outcome.outcome && one.cycle == outcome.cycle;
  });
}

OutcomeOfStart CycleHunt::probe_from(const LoopState& start, std::string name, double smallest_swing) {
  const double floor = std::exchange(settle_.amplitude_floor, std::max(settle_.amplitude_floor, smallest_swing));
  OutcomeOfStart outcome = simulate(start, std::move(name));
  settle_.amplitude_floor = floor;
  outcome.probe = true;
  if (is_news(outcome)) outcomes_.push_back(outcome);
  return outcome;
}

std::optional<std::size_t> CycleHunt::keep(const ShootingResult& shot) {
  maps_ += shot.maps;
  steps_ += shot.steps;
  if (shot.status != Status::converged || !shot.cycle.stable) return std::nullopt;
  if (shot.cycle.amplitude < settle_.amplitude_floor) return std::nullopt;
  return merge(cycles_, shot.cycle);
}

std::optional<std::size_t> CycleHunt::shoot_from(const OrbitGuess& guess) {
  ShootingOptions options = settle_.shooting;
  options.max_maps = 60;
  options.max_steps = steps_of_a_guess;
  return keep(shoot_multiple(loop_, guess, options));
}

std::optional<std::size_t> CycleHunt::edge_along(const std::function<LoopState(double scale)>& ray, double period) {
  settle_.known = cycles_;
  const Settled small = settle(loop_, ray(smallest_edge_scale), settle_),
                large = settle(loop_, ray(largest_edge_scale), settle_);
  steps_ += small.work + large.work;
  const bool same = small.outcome == large.outcome && small.outcome != Outcome::undecided && small.known == large.known;
  if (same && !small.shot && !large.shot) return std::nullopt;
  for (const Settled* end : {&small, &large})
    if (end->shot) merge(cycles_, end->shot->cycle);
  return edge_between(ray, period);
}

std::optional<std::size_t> CycleHunt::edge_between(const std::function<LoopState(double scale)>& ray, double period) {
  SettleOptions along = settle_;
  along.max_steps = steps_of_a_trend;
  return keep(edge_cycle(loop_, ray, period, along));
}

}  // namespace limcycle
