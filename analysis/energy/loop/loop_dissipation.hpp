#pragma once
#include <functional>
#include <optional>
#include <string>

#include "limcycle/analysis/energy/loop/circle.hpp"
#include "limcycle/analysis/energy/loop/rubbing_impedance.hpp"
#include "limcycle/analysis/energy/loop/sliding_stability.hpp"
#include "limcycle/analysis/energy/loop/stuck_set.hpp"

namespace limcycle {

/// Options of loop_dissipation().
struct LoopDissipationOptions {
  /// Viscous friction (N s/m) that makes the friction law passive; negative: its excess; NaN: unknown. For a law with a
  /// threshold of passivity in sigma2 it is that threshold less sigma2.
  double deficit = std::numeric_limits<double>::quiet_NaN();
  bool march = true;  ///< check by marches if stuck states attract
  std::function<bool()> stop;
};

/// Results for a loop by energy and by linearisation, each answer with its reason.
struct LoopDissipation {
  RubbingImpedance impedance;  ///< of the rest of the loop, at the friction
  Answer rest_is_passive;      ///< passivity of the rest of the loop from the friction force to minus the velocity
  Answer passivity;            ///< no cycle, by passivity of friction against the impedance
  CircleCriterion sector;      ///< for a forward element with bounded slopes
  Answer no_cycle;             ///< yes if one of the two proves it; otherwise why not
  StuckSet stuck;
  SlidingStability sliding;
};
LoopDissipation loop_dissipation(const Loop& loop, const LoopDissipationOptions& options = {});

}  // namespace limcycle
