#pragma once
#include <optional>

#include "limcycle/analysis/orbit/settle/settle.hpp"

namespace limcycle {

/// The known stable cycle of this swing of y with whose period the motion from here returns, if any. `steps` grows by
/// those of the return maps.
std::optional<std::size_t> known_cycle(const Loop& loop, const LoopState& here, double swing,
                                       const SettleOptions& options, long& steps);

/// Puts the shortest period of its orbit in the place of one found from swings that were still uneven, which may show
/// several periods as one. `steps` likewise.
void shorten(const Loop& loop, ShootingResult& shot, const Section& section, bool half, const ShootingOptions& options,
             long& steps);

}  // namespace limcycle
