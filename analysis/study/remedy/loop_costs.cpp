#include "limcycle/analysis/study/remedy/loop_costs.hpp"

#include "limcycle/analysis/study/remedy/actuator_travel.hpp"
#include "limcycle/analysis/study/remedy/linear_costs.hpp"
#include "limcycle/analysis/study/remedy/rest_range.hpp"
#include "limcycle/models/diagram/assemble.hpp"

namespace limcycle {

RemedyCosts loop_costs(const LoopParts& parts, double step, const Trace& response, bool rests) {
  RemedyCosts costs;
  const LinearCosts linear = linear_costs(parts, step);
  costs.linear_settling_time = linear.settling_time;
  costs.linear_overshoot = linear.overshoot;
  costs.phase_margin = linear.phase_margin;
  costs.delay_margin = linear.delay_margin;
  costs.peak_sensitivity = linear.peak_sensitivity;
  costs.noise_gain = linear.noise_gain;
  if (!uses_error(parts)) return costs;
  if (!parts.diagram)
    if (const auto range = rest_range(build_loop(parts)))
      costs.steady_state_error = Extent{parts.reference - range->high, parts.reference - range->low};
  if (rests && !response.y.empty()) {
    const StepNumbers real = step_numbers(response, response.y.front());
    costs.settling_time = real.settling_time;
    costs.overshoot = real.overshoot;
    costs.actuator_travel = actuator_travel(parts, step, response.t.back() - response.t.front());
  }
  return costs;
}

}  // namespace limcycle
