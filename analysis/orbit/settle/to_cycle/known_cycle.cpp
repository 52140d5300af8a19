#include "limcycle/analysis/orbit/settle/to_cycle/known_cycle.hpp"

#include <cmath>
#include <utility>

#include "limcycle/analysis/orbit/cycle/measure.hpp"

namespace limcycle {
namespace {

constexpr double similar = 0.02;  ///< relative difference of swings, before the motion is looked at more closely
constexpr double equal = 1e-4;    ///< of periods and amplitudes of one cycle
constexpr int most_maps = 4;      ///< within which the motion must return with the period of the cycle

bool comes_back(const Loop& loop, const LoopState& here, const Cycle& cycle, const SettleOptions& options,
                long& steps) {
  const Section section = choose_section(loop, cycle.trace);
  ReturnMap map(loop, section, std::nullopt,
                {options.rtol, options.shooting.max_steps_per_map, options.stop, false, infinite,
                 returns_of(section, cycle.trace)});
  auto at = map.approach(here);
  bool back = false;
  for (int k = 0; k < most_maps && !back && at.status == Status::converged; ++k) {
    at = map(at.state);
    if (at.status != Status::converged || std::abs(at.time / cycle.period - 1.0) > equal) continue;
    Trace again;
    if (record(loop, at.state, cycle.period, options.rtol, 200, again) != Status::converged) break;
    const auto [low, high] = extremes(again);
    back = std::abs((high - low) / (2.0 * cycle.amplitude) - 1.0) < equal;
  }
  steps += map.steps();
  return back;
}

}  // namespace

std::optional<std::size_t> known_cycle(const Loop& loop, const LoopState& here, double swing,
                                       const SettleOptions& options, long& steps) {
  for (std::size_t i = 0; i < options.known.size(); ++i) {
    const Cycle& cycle = options.known[i];
    if (cycle.stable == false || std::abs(2.0 * cycle.amplitude / swing - 1.0) > similar) continue;
    if (comes_back(loop, here, cycle, options, steps)) return i;
  }
  return std::nullopt;
}

void shorten(const Loop& loop, ShootingResult& shot, const Section& section, bool half, const ShootingOptions& options,
             long& steps) {
  constexpr double exactly = 1e-6;
  for (int fewer = 1; fewer < options.returns; ++fewer) {
    if (options.returns % fewer != 0) continue;
    ShootingOptions shorter = options;
    shorter.returns = fewer;
    shorter.warm_maps = 0;
    auto found = shoot(loop, shot.cycle.start, section, half, shorter);
    steps += found.steps;
    const double times = static_cast<double>(options.returns) / fewer;
    if (found.status != Status::converged) continue;
    if (std::abs(times * found.cycle.period / shot.cycle.period - 1.0) > exactly) continue;
    shot = std::move(found);
    return;
  }
}

}  // namespace limcycle
