#pragma once
#include <functional>
#include <vector>

#include "limcycle/analysis/energy/one_state/one_state_law.hpp"
#include "limcycle/analysis/energy/passivity/passivity.hpp"

namespace limcycle {

/// The most energy that a motion takes out of a law with one state while z passes a place in one direction, per unit of
/// |z|: sup over v of -F v/|f|.
struct PassingGain {
  double gain = -infinite;  ///< J per unit of z; -infinite if z cannot pass that way
  double v = 0.0;           ///< velocity at which, m/s
  double terms = 0.0;       ///< size of the terms of the gain: roundings are some epsilons of it
  bool endless = false;     ///< grows with the speed without bound
  bool unsure = false;      ///< rounding leaves open if it does
};

/// Condition at one state of a passive law: a storage S(z) has F v >= S'(z) f for every v, so that
///   least = sup over f < 0 of F v/f  <=  S'(z)  <=  most = inf over f > 0 of F v/f,  and F v >= 0 where f = 0.
/// If least > most, a cycle over [z, z + dz] takes out (least - most) dz, again and again.
struct SlopeGap {
  double z = 0.0;
  PassingGain up, down;
  double leak = 0.0;   ///< a velocity != 0 that holds z (f = 0) while F v < 0, m/s; 0: none
  bool finite = true;  ///< false if the law gave NaN or infinity

  double least() const { return down.gain; }
  double most() const { return -up.gain; }
  /// least - most over its terms, in [-1, 1]; above 0 energy can be taken out.
  double relative() const;
  /// yes: no energy can be taken out here (up to 64 roundings); undecided: within 1e-9 of it; no otherwise.
  Passive verdict() const;
};

/// The gap at z: a scan over the speeds of the law, every local extremum refined by golden section, every zero of f
/// bracketed, the growth beyond the last speed estimated from three decades (F v/f ~ a + b v). Some 1e3 evaluations.
SlopeGap slope_gap(const OneStateLaw& law, double z);

/// The gaps over all reachable states.
struct SlopeSurvey {
  Passive passive = Passive::undecided;
  std::vector<SlopeGap> gaps;  ///< ascending in z
  SlopeGap worst;              ///< the one with the largest `relative`, or the first violation
  Status status = Status::converged;
};

/// A grid of states, uniform and graded towards both ends of the reachable range and towards 0, refined by golden
/// section where the gap has a local maximum close to 0. `complete` false: ends at the first violation.
SlopeSurvey survey_slopes(const OneStateLaw& law, bool complete, const std::function<bool()>& stop = {});

/// Passivity of a law with one state, without a counter-example: the test that thresholds repeat.
Passive one_state_verdict(const Element& law, double top_speed, const std::function<bool()>& stop = {});

}  // namespace limcycle
