#pragma once
#include <optional>

#include "limcycle/analysis/motion/field/loop_field.hpp"

namespace limcycle {

/// Start of a motion at the release of a constant load.
struct LoadStep {
  double load = 0.0;  ///< constant force on the plant before the release
  LoopState start;    ///< at rest under it: an integrator is wound up, a spring stretched accordingly
};

/// The start after a load of twice the level of the friction, which no stiction hides. Empty without friction, if the
/// loop does not rest under such a load (nothing holds it, or the command is limited), and if it equals displaced().
/// Cost O(n^3).
std::optional<LoadStep> load_step(const Loop& loop);

}  // namespace limcycle
