#pragma once
#include <optional>

#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Travel of the actuator, N: the sum of all changes of its force on the plant, jumps included, from the displacement
/// of y by `step` until `duration`, s. The force is read at the ends and the quarters of every step of the integrator,
/// so that at most about a sixteenth of its swing within a step is not seen. Empty for a diagram, a sampled controller,
/// a dead time, and where the run cannot go on. Cost: one run.
std::optional<double> actuator_travel(const LoopParts& parts, double step, double duration);

}  // namespace limcycle
