#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "limcycle/analysis/orbit/cycle/shooting.hpp"
#include "limcycle/analysis/orbit/settle/irregular.hpp"

namespace limcycle {

/// Outcome of a motion. family: periodic, one of a continuum of periodic motions (a centre). irregular: bounded and
/// permanent, but never periodic.
enum class Outcome { rest, sliding, cycle, divergence, undecided, family, irregular };
std::string_view to_string(Outcome outcome);

/// Length and accuracy of the simulation until its outcome is decided.
struct SettleOptions {
  double rtol = 1e-7;              ///< of the simulation; looser ones may break stiction early
  double amplitude_floor = 1e-9;   ///< swings of y below this have died out
  double amplitude_ceiling = 1e6;  ///< |y| beyond this has diverged
  long max_steps = 60000;          ///< the horizon: steps, not seconds, so that it follows the loop's own time scales
  long max_readings = 5'000'000;   ///< of a sampled loop: switches of its clocks
  /// Turns of y, after swings of a good part of its range, that tell a motion without a period: with fewer, the horizon
  /// is four times as long; 0: it never is.
  std::size_t fewest_turns = 100;
  ShootingOptions shooting;
  std::span<const Cycle> known;  ///< cycles found before: recognised by period and swing (to 1e-4) without shooting
  std::span<const IrregularMotion> known_irregular;  ///< and permanent motions, recognised by their numbers (agree())
  std::function<bool()> stop;
};

/// Result from one initial state.
struct Settled {
  Outcome outcome = Outcome::undecided;
  std::string why;                     ///< one sentence
  std::string by;                      ///< "switching": rest reached through ever faster switching; else empty
  IrregularMotion irregular;           ///< the numbers of an irregular motion
  std::optional<ShootingResult> shot;  ///< for a new cycle
  std::optional<std::size_t> known;    ///< index of the known cycle that was reached
  std::vector<Cycle> passed;           ///< unstable cycles near which the motion was for a while
  Trace trace;
  double time = 0.0;  ///< simulated, s
  long steps = 0;     ///< of the simulation
  long work = 0;      ///< the same plus those of all return maps tried on the way
};

/// Simulates from `start` until the outcome is decided. A motion counts as a cycle only when shooting from it finds a
/// stable periodic solution with the same swing, so never for a decaying stick-slip, whose swings shrink for ever. It
/// counts as rest only when every rate has decayed faster than 1/t or is noise on the mean (see RestWatch), so never
/// for slow hunting, which rests for thousands of seconds while an integrator winds up. A motion that drifts on slowly
/// from period to period is followed over many at once (follow_drift()): `trace` has gaps there, `time` has none, and
/// the step limit begins anew. If neither test decides within the step limit, the outcome is undecided. Throws
/// std::invalid_argument for a loop with a dead time: see in_time_domain().
Settled settle(const Loop& loop, const LoopState& start, const SettleOptions& options);

/// State in which a slow move has displaced y from the rest point of the linear part by `displacement`, elements
/// without history: the loop at rest at another set-point; if no reference moves y, under a load. If neither holds y
/// still (a free mass), the turning point of a slow oscillation. The motion is the same in any coordinates of the
/// states. Cost O(n^3).
LoopState displaced(const Loop& loop, double displacement);

}  // namespace limcycle
