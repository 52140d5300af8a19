#pragma once
#include <optional>

#include "limcycle/analysis/motion/steppers/stepper_kind.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"

namespace limcycle {

/// The cycle of a sampled loop from here whose period is that whole number of samples, if the state repeats itself
/// after it: at once, and after eight periods no less. Multipliers say little of it: within a quantum they are 0 or 1.
/// Error: that of the repetition, or of the march if that is more. `steps` grows by those of the marches.
std::optional<ShootingResult> locked_cycle(const Loop& loop, const LoopState& here, double samples, StepperKind kind,
                                           const SettleOptions& options, long& steps);

}  // namespace limcycle
