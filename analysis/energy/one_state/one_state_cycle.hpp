#pragma once
#include <optional>

#include "limcycle/analysis/energy/one_state/one_state_law.hpp"
#include "limcycle/analysis/energy/passivity/passivity.hpp"
#include "limcycle/analysis/energy/passivity/storage_slopes.hpp"

namespace limcycle {

/// A cycle of two constant velocities: z rises from z1 to z2 at v_up and falls back at v_down.
struct TwoSpeedCycle {
  double z1 = 0.0, z2 = 0.0, v_up = 0.0, v_down = 0.0;
  double time_up = 0.0, time_down = 0.0;
  double energy = 0.0, error = 0.0;  ///< taken out in the periodic motion, J, by quadrature over z
  /// Growth factor of a small difference from the periodic motion over one cycle; below 1 the law without history
  /// converges to it.
  double multiplier = 1.0;
};

/// Sets the energy, its error and the times of a cycle, by adaptive Gauss-Kronrod quadrature over z (31 points, 1e-12).
void integrate(const OneStateLaw& law, TwoSpeedCycle& cycle);

/// Number of reaches of a search for cycles: 0 avoids the ends of the states and creep, 3 goes to both.
inline constexpr int reaches = 4;

/// Up to four cycles that take energy out, the most plausible first: those that take out a tenth of the law's own
/// energy (its force times its displacement) at the least top speed, then those that take out the most. Speeds up to
/// the law's top speed, 1e15 velocity scales at most. A law with a spring to x = 0 gets cycles that return to their
/// start.
std::vector<TwoSpeedCycle> two_speed_cycles(const OneStateLaw& law, const SlopeSurvey& survey, int reach);

/// The first of them, from the smallest reach on, that the independent simulation confirms to 1e-6; none if no cycle is
/// confirmed.
std::optional<Counterexample> one_state_counterexample(const OneStateLaw& law, const SlopeSurvey& survey,
                                                       const PassivityOptions& options);

}  // namespace limcycle
