#pragma once

namespace limcycle {

/// From now on the first SIGINT (Ctrl-C) or SIGTERM only raises a flag; a second one ends the program at once.
void catch_interrupts();

/// Raises the flag too: what this process computes is not wanted any more.
void interrupt();

/// Has the user asked to stop, or interrupt() been called? Cheap, safe from any thread.
bool interrupted();

/// Has the user?
bool interrupted_by_signal();

}  // namespace limcycle
