#pragma once

namespace limcycle {

/// Limits of the parts of predict(), counted in steps and evaluations and never in seconds, so that the answer is the
/// same on every machine and with any number of threads. The starts come first and have their own horizon
/// (SettleOptions::max_steps); later parts have a share of the steps that the starts took, and enough for a loop whose
/// starts end at once.
struct WorkShare {
  long between_steps;        ///< of the integrator, in simulations between starts that end differently
  long composite_steps;      ///< of the integrator, in the search of the composite describing function
  long df_evaluations;       ///< of the main element, in the search for roots of 1 + N G
  long check_steps;          ///< of the integrator, in the simulations and shooting that check predictions
  long balance_evaluations;  ///< of the equations of harmonic balance, for all its starts
};

/// `steps`: of the integrator, from all starts, shooting included.
WorkShare work_share(long steps);

}  // namespace limcycle
