#pragma once
#include <functional>
#include <optional>
#include <string>

#include "limcycle/analysis/energy/circle.hpp"
#include "limcycle/analysis/energy/rubbing_impedance.hpp"
#include "limcycle/analysis/energy/sliding_stability.hpp"
#include "limcycle/analysis/energy/stuck_set.hpp"

namespace limcycle {

/// What is asked of a loop.
struct LoopDissipationOptions {
  /// Viscous friction (N s/m) that makes the friction law passive; negative: what it has to spare; NaN: not known. For
  /// a law with a threshold of passivity in sigma2 it is that threshold less sigma2.
  double deficit = std::numeric_limits<double>::quiet_NaN();
  bool march = true;  ///< check by marches whether stuck states attract
  std::function<bool()> stop;
};

/// What can be said of a loop by energy and by linearisation, each answer with its reason.
struct LoopDissipation {
  RubbingImpedance impedance;  ///< that friction feels of the rest of the loop
  Answer rest_is_passive;      ///< is the rest of the loop passive from the friction force to minus the velocity?
  Answer passivity;            ///< no cycle, by passivity of friction against the impedance
  CircleCriterion sector;      ///< for a forward element with bounded slopes
  Answer no_cycle;             ///< yes if one of the two proves it; else why not
  StuckSet stuck;
  SlidingStability sliding;
};
LoopDissipation loop_dissipation(const Loop& loop, const LoopDissipationOptions& options = {});

}  // namespace limcycle
