#pragma once
#include <functional>

#include "limcycle/analysis/orbit/settle/settle.hpp"

namespace limcycle {

/// Ends of the ray that edge_cycle() searches, as factors of the guessed initial states.
inline constexpr double smallest_edge_scale = 0.1, largest_edge_scale = 3.0;

/// An unstable cycle as the border between motions that shrink and motions that grow: along a ray of initial states,
/// the last one whose swings shrink and the first whose swings grow are bisected together. The motion from there stays
/// near the unstable cycle that separates them for some swings, and shooting starts from where these are most alike.
/// `period` is a guess. Status no_cycle: there is no such change on the ray. Cost: about 30 simulations of a few
/// periods, or 50 if the first border is not yet near enough.
ShootingResult edge_cycle(const Loop& loop, const std::function<LoopState(double scale)>& ray, double period,
                          const SettleOptions& options);

}  // namespace limcycle
