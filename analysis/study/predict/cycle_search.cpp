#include "limcycle/analysis/study/predict/cycle_search.hpp"

#include <algorithm>

#include "limcycle/analysis/motion/sampling.hpp"
#include "limcycle/analysis/motion/steppers/stepper_limits.hpp"
#include "limcycle/analysis/study/balance/output_per_input.hpp"
#include "limcycle/models/element/of_controllers/sampled.hpp"

namespace limcycle {

namespace {

/// Of what sampled controllers read, in the unit of y: a loop hunts by some of them, however little friction it has.
double largest_quantum(const Loop& loop) {
  double largest = 0.0;
  for (std::size_t i = 0; i < loop.elements.size(); ++i)
    if (const auto* sampled = sampled_at(loop, i)) largest = std::max(largest, sampled->input_quantum);
  return largest;
}

/// How often the force of the last friction law goes into that of the strongest: the box is that of the last.
double strongest_friction(const Loop& loop) {
  double largest = 0.0;
  for (std::size_t i = 0; i < loop.elements.size(); ++i)
    if (loop.ports[i].opposes) largest = std::max(largest, loop.elements[i].scales().output);
  const double last = loop.elements.back().scales().output;
  return loop.ports.back().opposes && last > 0.0 ? std::max(1.0, largest / last) : 1.0;
}

}  // namespace

SettleOptions cycle_search(const Loop& loop, const SearchBox& box, double accuracy, std::function<bool()> stop) {
  const double unit = output_per_input(loop);
  SettleOptions options;
  options.amplitude_floor = unit * box.amplitude_min;
  options.amplitude_ceiling =
      1e4 * std::max(strongest_friction(loop) * unit * box.amplitude_max, largest_quantum(loop));
  options.rtol = std::clamp(0.1 * loosest_stiff_tolerance(loop), 1e-12, options.rtol);
  options.shooting.accuracy = accuracy;
  options.shooting.rtol = std::clamp(accuracy, 1e-13, 1e-8);
  options.shooting.tolerance = 0.1 * options.shooting.rtol;
  options.shooting.derivative_rtol = std::clamp(accuracy, 1e-10, 1e-8);
  options.shooting.stop = stop;
  options.stop = std::move(stop);
  return options;
}

std::vector<double> extend_down(SearchBox& box, double smallest, int starts) {
  constexpr double decades = 1e-6, between = 0.01;
  box.amplitude_min *= decades;
  std::vector<double> displacements(static_cast<std::size_t>(std::min(starts, 3)));
  for (double& displacement : displacements) displacement = smallest *= between;
  return displacements;
}

}  // namespace limcycle
