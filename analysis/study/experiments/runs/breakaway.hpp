#pragma once
#include "limcycle/analysis/study/experiments/runs/forced_run.hpp"
#include "limcycle/analysis/study/experiments/runs/laws.hpp"

namespace limcycle {

/// Break-away of a mass of 1 kg under a force that rises from 0 with `rate` (N/s), by both definitions.
struct BreakAway {
  double peak = NAN;          ///< largest friction force up to the gross displacement, N
  double displacement = NAN;  ///< at the peak (at 99.9 % of it for a force that only approaches it), m
  double velocity = NAN;      ///< at the peak, m/s
  double applied = NAN;       ///< applied force when x reaches the gross displacement, N
  double stiffness = NAN;     ///< secant slope u/x at a tenth of the peak, N/m
  double slope = NAN;         ///< mean fall of F over x between 3/4 and 1/4 of the drop after the peak, N/m
  double fall_time = NAN;     ///< time that this part of the drop takes, s
  ForcedRun run;
};

/// `gross` (m): the gross displacement. A law that has not broken away when the force has reached four times 1.5 N
/// keeps NaN.
BreakAway break_away(const LawSetting& setting, double rate, double gross, double rtol = 1e-8);

/// Twice the displacement by which the law has broken away.
inline double gross_displacement(const LawSetting& setting) { return 2.0 * setting.break_away; }

}  // namespace limcycle
