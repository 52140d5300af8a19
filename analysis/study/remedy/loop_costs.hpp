#pragma once
#include <optional>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/energy/loop/holding_forces.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// What a loop costs its user. Empty: not known.
struct RemedyCosts {
  /// r - y over all states in which the loop stands still: see rest_range(). Ends may be infinite.
  std::optional<Extent> steady_state_error = {};
  std::optional<double> settling_time = {}, overshoot = {};  ///< s and share of the step, of the loop with its friction
  std::optional<double> linear_settling_time = {}, linear_overshoot = {};  ///< of the loop without friction
  std::optional<double> phase_margin = {}, delay_margin = {}, peak_sensitivity = {}, noise_gain = {};  ///< LinearCosts
  std::optional<double> actuator_travel = {};  ///< N, of the real step: see actuator_travel()
  std::optional<double> robust_share = {};     ///< of the samples of a spread, those in which the loop does not hunt
};

/// All but the robust share. `step`: height of a step, `response`: the run of the loop with its friction from it;
/// `rests`: whether the loop does not hunt, so that the run has an end. Cost: linear_costs(), rest_range(), a run in
/// time.
RemedyCosts loop_costs(const LoopParts& parts, double step, const Trace& response, bool rests);

}  // namespace limcycle
