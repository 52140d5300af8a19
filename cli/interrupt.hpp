#pragma once
#include "limcycle/analysis/status.hpp"

namespace limcycle {

/// From now on the first SIGINT (Ctrl-C) or SIGTERM only raises a flag; one that comes a second later or more ends the
/// program at once. Signals in between count as the same request: `timeout` and `mpirun` signal the program and then
/// its group, so that one Ctrl-C arrives twice, and the computed results would be lost.
void catch_interrupts();

/// Raises the flag too: the results of this process are no longer needed.
void interrupt();

/// Raises the flag because the time of --time-limit is over.
void time_is_over();

/// True if the user asked to stop, the time is over, or interrupt() was called. Cheap, safe from any thread.
bool interrupted();

/// True if the user asked to stop.
bool interrupted_by_signal();

/// True if the time was over before the user asked to stop.
bool interrupted_by_time();

/// Status of a command whose work has none of its own: converged, or interrupted.
Status ending_so_far();

}  // namespace limcycle
