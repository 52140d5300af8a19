#pragma once

namespace limcycle {

/// From now on the first SIGINT (Ctrl-C) or SIGTERM only raises a flag; a second one ends the program at once.
void catch_interrupts();

/// Raises that flag: what computes on this rank is not wanted any more.
void interrupt();

/// Has the user asked to stop? Cheap, safe from any thread.
bool interrupted();

}  // namespace limcycle
