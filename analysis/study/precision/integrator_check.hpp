#pragma once
#include <functional>
#include <string>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/motion/march.hpp"

namespace limcycle {

/// Settings of a stepper's run on a cycle.
struct IntegratorCheckOptions {
  StepperKind stepper = StepperKind::automatic;
  double rtol = 1e-7;
  int periods = 10;          ///< >= 4
  long max_steps = 1000000;  ///< step limit; ends earlier if the first periods show that it will be exceeded
  std::function<bool()> stop;
};

/// A simulation that begins on a known cycle, and its results.
struct IntegratorCheck {
  Status status = Status::converged;
  bool gave_up = false;      ///< it needs more than max_steps
  bool periodic = false;     ///< it kept returning
  double period = 0.0;       ///< s, mean over the second half of the run
  double spread = 0.0;       ///< (longest - shortest)/mean of these
  double amplitude = 0.0;    ///< half the peak-to-peak of y over the last period
  double state_error = 0.0;  ///< largest |x - x_known| of a linear state over the largest value it has on the cycle,
                             ///< after exactly `periods` periods of the known cycle: error of phase included
  long steps = 0;
  double measuring = 0.0;  ///< CPU seconds spent on the amplitude after the run
};

/// Largest |x| of every linear state over one period of a cycle.
State sizes_on_cycle(const Loop& loop, const Cycle& cycle);

/// Marches from the start of the cycle with a given stepper and tolerance for some of its periods. Extremes of y are
/// located by marching to them, so that the amplitude is as accurate as the stepper at any step size. `sizes`: of
/// sizes_on_cycle. Throws std::invalid_argument if the stepper does not apply to the loop.
IntegratorCheck check_integrator(const Loop& loop, const Cycle& cycle, const State& sizes,
                                 const IntegratorCheckOptions& options);

}  // namespace limcycle
