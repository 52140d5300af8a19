#include "limcycle/analysis/orbit/settle/surroundings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/orbit/cycle/return_map.hpp"

namespace limcycle {

Surroundings::Surroundings(const Loop& loop, const Cycle& cycle, const Section& section, const ShootingOptions& options,
                           double rtol)
    : loop_(loop), cycle_(cycle), section_(section), options_(options), rtol_(rtol) {
  middle_ = opposite().x;
  for (std::size_t i = 0; i < middle_.size(); ++i) middle_[i] = 0.5 * (middle_[i] + cycle.start.x[i]);
}

/// The state half a period after the start; the start itself if the march does not get there.
LoopState Surroundings::opposite() const {
  LoopField field(loop_);
  field.modes() = cycle_.start.modes;
  March march(field, StepperKind::automatic, loop_weights(loop_, rtol_));
  march.begin(cycle_.start.x, 0.0);
  const double half = 0.5 * cycle_.period;
  while (march.t() < half)
    if (march.steps() > options_.max_steps_per_map || march.step(half) != Status::converged) return cycle_.start;
  return {march.x(), field.modes()};
}

/// The start, `factor` times as far from the middle between it and the state half a period later.
LoopState Surroundings::farther_out(double factor) const {
  LoopState moved = cycle_.start;
  for (std::size_t i = 0; i < moved.x.size(); ++i) moved.x[i] += (factor - 1.0) * (moved.x[i] - middle_[i]);
  return moved;
}

bool Surroundings::attracts() {
  constexpr double aside = 0.01, left = 0.05;
  constexpr int periods = 24;
  const State sizes = typical_sizes(loop_);
  const auto distance = [&](const State& x) {
    double largest = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i)
      largest = std::max(largest, std::abs(x[i] - cycle_.start.x[i]) / sizes[i]);
    return largest;
  };
  ReturnMap map(
      loop_, section_, std::nullopt,
      {rtol_, options_.max_steps_per_map, options_.stop, false, infinite, returns_of(section_, cycle_.trace)});
  bool back = true;
  for (const double side : {1.0 + aside, 1.0 - aside}) {
    const LoopState other = farther_out(side);
    const double before = distance(other.x);
    auto at = map.approach(other);
    const auto is_back = [&] { return distance(at.state.x) < left * before; };
    for (int k = 0; k < periods && at.status == Status::converged && !is_back(); ++k) at = map(at.state);
    back = back && at.status == Status::converged && is_back();
  }
  steps_ += map.steps();
  return back;
}

bool Surroundings::has_neighbour(bool half) {
  constexpr double aside = 0.02, apart = 0.005;
  ShootingOptions there = options_;
  there.warm_maps = 0;
  return std::ranges::any_of(std::array{1.0 + aside, 1.0 - aside}, [&](double factor) {
    const auto found = shoot(loop_, farther_out(factor), section_, half, there);
    steps_ += found.steps;
    const double larger = found.cycle.amplitude / cycle_.amplitude - 1.0;
    return found.status == Status::converged && std::abs(larger) > apart && std::abs(larger) < 10.0 * aside;
  });
}

}  // namespace limcycle
