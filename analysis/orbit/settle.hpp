#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "limcycle/analysis/orbit/shooting.hpp"

namespace limcycle {

/// What a motion comes to. family: periodic, one of a continuum of periodic motions (a centre). irregular: bounded and
/// permanent, but never periodic.
enum class Outcome { rest, sliding, cycle, divergence, undecided, family, irregular };
std::string_view to_string(Outcome outcome);

/// How long and how accurately a motion is followed until it is clear what it comes to.
struct SettleOptions {
  double rtol = 1e-7;              ///< of the simulation; looser ones may break stiction early
  double amplitude_floor = 1e-9;   ///< swings of y below this have died out
  double amplitude_ceiling = 1e6;  ///< |y| beyond this has diverged
  long max_steps = 60000;          ///< the horizon: steps, not seconds, so that it follows the loop's own time scales
  ShootingOptions shooting;
  std::span<const Cycle> known;  ///< cycles found before: recognised by period and swing (to 1e-4) without shooting
  std::function<bool()> stop;
};

/// What is reached from one initial state.
struct Settled {
  Outcome outcome = Outcome::undecided;
  std::string why;                     ///< one sentence
  std::string by;                      ///< "switching": rest reached through ever faster switching; else empty
  double half_range = 0.0;             ///< of an irregular motion: half of largest less least y; else 0
  double mean_period = 0.0;            ///< of an irregular motion: mean time between returns to its middle, s; else 0
  std::optional<ShootingResult> shot;  ///< for a new cycle
  std::optional<std::size_t> known;    ///< index of the known cycle that was reached
  Trace trace;
  double time = 0.0;  ///< simulated, s
  long steps = 0;     ///< of the simulation
  long work = 0;      ///< the same and those of all return maps tried on the way
};

/// Simulates from `start` until it is clear what is reached. A cycle is one only when shooting from the motion finds a
/// stable periodic solution with the same swing: a decaying stick-slip, whose swings shrink for ever, never is. Rest is
/// one only when every rate has decayed faster than 1/t or is noise on the mean (see RestWatch): slow hunting, which
/// waits at rest for thousands of seconds while an integrator winds up, never is. What neither test decides within the
/// budget is undecided. Throws std::invalid_argument for a loop with a dead time: see in_time_domain().
Settled settle(const Loop& loop, const LoopState& start, const SettleOptions& options);

/// State in which y (from the rest point of the linear part, elements without history) is displaced by `displacement`,
/// and the other states as little as possible; where that would only move a fast pole (by a factor of 1000 from the
/// others), so that y is back before anything else moves, the turning point of a slow oscillation of that amplitude.
LoopState displaced(const Loop& loop, double displacement);

}  // namespace limcycle
