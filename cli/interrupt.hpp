#pragma once

namespace limcycle {

/// From now on the first SIGINT (Ctrl-C) or SIGTERM only raises a flag; one that comes a second later or more ends the
/// program at once. Those in between are taken for the same wish: `timeout` and `mpirun` signal the program and then
/// its group, so that one Ctrl-C comes twice, and what was computed would be lost.
void catch_interrupts();

/// Raises the flag too: what this process computes is not wanted any more.
void interrupt();

/// Has the user asked to stop, or interrupt() been called? Cheap, safe from any thread.
bool interrupted();

/// Has the user?
bool interrupted_by_signal();

}  // namespace limcycle
