#include "limcycle/analysis/orbit/return_map.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/motion/tolerances.hpp"

namespace limcycle {

LoopState Reflection::of(const Loop& loop, const LoopState& state) const {
  LoopState mirrored = state;
  for (std::size_t i = 0; i < mirrored.x.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    mirrored.x[i] = (k < centre.size() ? 2.0 * centre(k) : 0.0) - state.x[i];
  }
  for (std::size_t i = 0; i < mirrored.modes.size(); ++i)
    mirrored.modes[i] = std::visit([&](const auto& e) { return e.mirror(state.modes[i]); }, loop.elements[i]);
  return mirrored;
}

std::optional<Reflection> symmetry(const Loop& loop) {
  for (const auto& element : loop.elements)
    if (!std::visit([](const auto& e) { return e.odd(); }, element)) return std::nullopt;
  bool exact = false;
  const Eigen::VectorXd rest = loop.rest_point(exact);
  if (!exact) return std::nullopt;
  for (const Port& port : loop.ports) {
    const double input = (port.C * rest + port.c * loop.external).value();
    const double rate = (port.C_v * rest + port.c_v * loop.external).value();
    const bool rubs = port.path == "loop.friction";  // a friction law minds where it is only by its own state
    if (std::abs(rate) > 1e-12 || (!rubs && std::abs(input) > 1e-12)) return std::nullopt;
  }
  return Reflection{rest};
}

ReturnMap::ReturnMap(const Loop& loop, Section section, std::optional<Reflection> half, Options options)
    : loop_(&loop), field_(loop), section_(std::move(section)), half_(std::move(half)), options_(std::move(options)) {}

ReturnMap::Result ReturnMap::run(const LoopState& from, const Section& target) {
  Result result;
  field_.modes() = from.modes;
  March march(field_, StepperKind::automatic, loop_weights(*loop_, options_.rtol));
  march.begin(from.x, 0.0, target);
  result.largest.assign(from.x.size(), 0.0);
  do {
    if (options_.stop && options_.stop()) result.status = Status::interrupted;
    if (march.steps() > options_.max_steps) result.status = Status::max_iterations;
    if (result.status == Status::converged) result.status = march.step(infinite);
    for (std::size_t i = 0; i < result.largest.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const double centre = half_ && k < half_->centre.size() ? half_->centre(k) : 0.0;
      result.largest[i] = std::max(result.largest[i], std::abs(march.x()[i] - centre));
    }
  } while (result.status == Status::converged && !march.last().on_section);
  steps_ += march.steps();
  result.state = {march.x(), field_.modes()};
  result.time = march.t();
  return result;
}

ReturnMap::Result ReturnMap::approach(const LoopState& from) { return run(from, section_); }

ReturnMap::Result ReturnMap::operator()(const LoopState& from) {
  if (!half_) return run(from, section_);
  const double middle = (section_.C * half_->centre).value();
  Result result = run(from, Section{section_.C, 2.0 * middle - section_.level, -section_.direction});
  result.state = half_->of(*loop_, result.state);
  return result;
}

}  // namespace limcycle
