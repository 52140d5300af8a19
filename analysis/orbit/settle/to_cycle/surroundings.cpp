#include "limcycle/analysis/orbit/settle/to_cycle/surroundings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/orbit/cycle/return_map.hpp"

namespace limcycle {

Surroundings::Surroundings(const Loop& loop, const Cycle& cycle, const Section& section, const ShootingOptions& options,
                           double rtol)
    : loop_(loop), cycle_(cycle), section_(section), options_(options), rtol_(rtol), sizes_(typical_sizes(loop)) {
  middle_ = opposite().x;
  for (std::size_t i = 0; i < middle_.size(); ++i) {
    middle_[i] = 0.5 * (middle_[i] + cycle.start.x[i]);
    sizes_[i] = std::max(sizes_[i], std::abs(cycle.start.x[i] - middle_[i]));
  }
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

/// Largest difference of two states, in units of their typical sizes.
double Surroundings::distance(const State& one, const State& other) const {
  double largest = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) largest = std::max(largest, std::abs(one[i] - other[i]) / sizes_[i]);
  return largest;
}

/// The return map over the whole period of the cycle.
ReturnMap Surroundings::map_of_period() const {
  return {loop_,
          section_,
          std::nullopt,
          {rtol_, options_.max_steps_per_map, options_.stop, false, infinite, returns_of(section_, cycle_.trace)}};
}

bool Surroundings::attracts() {
  constexpr double aside = 0.01, left = 0.05;
  constexpr int periods = 24;
  ReturnMap map = map_of_period();
  bool back = true;
  for (const double side : {1.0 + aside, 1.0 - aside}) {
    const LoopState other = farther_out(side);
    const double before = distance(other.x, cycle_.start.x);
    auto at = map.approach(other);
    const auto is_back = [&] { return distance(at.state.x, cycle_.start.x) < left * before; };
    for (int k = 0; k < periods && at.status == Status::converged && !is_back(); ++k) at = map(at.state);
    back = back && at.status == Status::converged && is_back();
  }
  steps_ += map.steps();
  return back;
}

bool Surroundings::has_twins(const Eigen::VectorXd& neutral) {
  constexpr double above_tolerance = 1e4;
  double size = 0.0;
  for (std::size_t i = 0; i < sizes_.size(); ++i)
    size = std::max(size, std::abs(neutral(static_cast<Eigen::Index>(i))) / sizes_[i]);
  const auto beside = [&](double way) {
    LoopState moved = cycle_.start;
    Eigen::Map<Eigen::VectorXd>(moved.x.data(), neutral.size()) += way / size * neutral;
    return moved;
  };
  // Where a sample is taken just before a switch the family ends close by.
  const bool exact = choose_stepper(loop_, rtol_) == StepperKind::exact;
  return std::ranges::any_of(std::array{1e-2, 1e-3, 1e-4, 1e-5}, [&](double aside) {
    return (exact || aside > above_tolerance * rtol_) && has_twin(beside(aside), aside) &&
           has_twin(beside(-aside), aside);
  });
}

bool Surroundings::has_twin(const LoopState& beside, double aside) {
  constexpr int periods = 100;
  constexpr double still = 1e-4;
  const double equal = 1e-3 * aside, before = distance(beside.x, cycle_.start.x);
  ReturnMap map = map_of_period();
  map.set_extremes(true);
  auto at = map.approach(beside);
  double moved = infinite;
  for (int k = 0; k < periods && at.status == Status::converged && !(moved <= still * before); ++k) {
    const State last = at.state.x;
    at = map(at.state);
    moved = distance(at.state.x, last);
  }
  steps_ += map.steps();
  return at.status == Status::converged && moved <= still * before &&
         distance(at.state.x, cycle_.start.x) > 0.5 * before && std::abs(at.time / cycle_.period - 1.0) <= equal &&
         std::abs(map.amplitude(at) / cycle_.amplitude - 1.0) <= equal;
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
