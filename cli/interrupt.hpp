#pragma once
#include "limcycle/analysis/status.hpp"

namespace limcycle {

/// From now on the first SIGINT (Ctrl-C) or SIGTERM only raises a flag; one that comes a second later or more ends the
/// program at once. Those in between are taken for the same wish: `timeout` and `mpirun` signal the program and then
/// its group, so that one Ctrl-C comes twice, and what was computed would be lost.
void catch_interrupts();

/// Raises the flag too: what this process computes is not wanted any more.
void interrupt();

/// Raises the flag because the time of --time-limit is over.
void time_is_over();

/// Has the user asked to stop, is the time over, or was interrupt() called? Cheap, safe from any thread.
bool interrupted();

/// Has the user?
bool interrupted_by_signal();

/// Was the time over before the user asked?
bool interrupted_by_time();

/// How a command ends whose work says nothing of it: converged, or interrupted.
Status ending_so_far();

}  // namespace limcycle
