#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limcycle/analysis/study/remedy/hunts.hpp"
#include "limcycle/analysis/study/tune/squared_error.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// What may be made least: the peak sensitivity Ms of the linear loop, the settling time of the loop with its friction
/// (s), and the integral of its squared error (ise), both after a step of the displacement from which predict() starts.
enum class TuneCost { ms, settling, ise };
inline constexpr std::string_view tune_cost_names[] = {"ms", "settling", "ise"};
inline std::string_view to_string(TuneCost cost) { return tune_cost_names[static_cast<std::size_t>(cost)]; }
using TuneCosts = std::array<std::optional<double>, std::size(tune_cost_names)>;

/// True if a cost is lower by more than a ten-thousandth, so that four digits show it.
inline bool is_lower(double cost, double than) { return cost < than - 1e-4 * std::abs(than); }

/// What became of a point.
enum class TuneOutcome {
  feasible,     ///< no start hunts, and no limit is exceeded
  hunts,        ///< as Hunts::yes; the next three likewise
  neutral,      ///<
  diverges,     ///<
  undecided,    ///<
  unstable,     ///< the linear loop is
  fragile,      ///< it does not hunt itself, but is not feasible with one number changed by the margin
  above_limit,  ///< a cost exceeds its limit
  invalid,      ///< the numbers break a rule of the loop
  not_judged    ///< allowed as far as it is known; whether it hunts was not asked, because its cost is no better
};
std::string_view to_string(TuneOutcome outcome);

/// A point of the search.
struct TunePoint {
  /// What it was tried for: the present values, the design, a local search, the neighbourhood of the result.
  enum class Part { own, design, search, neighbour };
  std::vector<double> values;
  Part part = Part::design;
  std::size_t search = 0;  ///< number of the local search
  TuneOutcome outcome = TuneOutcome::not_judged;
  TuneCosts costs{};                     ///< those that were wanted and known
  std::string why{};                     ///< one clause; may be empty
  std::optional<MotionState> hunting{};  ///< a state on its hunting motion, if it has a cycle
};
std::string_view to_string(TunePoint::Part part);

/// The loop with other values; empty if they are not valid.
using LoopWith = std::function<std::optional<LoopParts>(std::span<const double>)>;

/// What is asked of every point.
struct TuneQuestion {
  LoopWith loop_with;
  TuneCost minimised = TuneCost::ms;
  TuneCosts limits{};    ///< largest costs that are allowed
  double horizon = 0.0;  ///< s, of ise
  double step = 0.0;     ///< height of the step
  bool linear = true;    ///< the loop has a linear one: see linear_costs()
  Judging judging;       ///< with a search box
  /// Other values at which the loop must not hunt either, for those of a point; empty: none.
  std::function<std::vector<std::vector<double>>(std::span<const double>)> margin = {};

  bool wants(TuneCost cost) const { return minimised == cost || limits[static_cast<std::size_t>(cost)]; }
  std::optional<double> cost_of(const TunePoint& point) const {
    return point.costs[static_cast<std::size_t>(minimised)];
  }
};

/// The cheap part: whether the values are valid, the linear loop is stable, the costs and their limits. For ise a run
/// over the horizon is made, for settling one until it has come to rest: a motion that needs more than 5000 steps for
/// it was not decided, and one that ends more than a tenth of the step from the set-point exceeds a limit. The outcome
/// stays not_judged if nothing speaks against the point; without a cost if it was interrupted.
void look_at(TunePoint& point, const TuneQuestion& question);

/// The run of a loop from the step, until its outcome is decided or this many steps are made.
Settled run_from_step(const LoopParts& parts, const TuneQuestion& question, long steps = 60'000);

/// ise of a loop and its error; empty if the run fails.
std::optional<SquaredError> squared_error_of(const LoopParts& parts, const TuneQuestion& question);

/// The dear part, for a point that look_at() left not_judged: one run, which mostly suffices to see that a loop hunts
/// (one that does not come to rest in 60 000 steps was not decided), then hunts() from all starts, then runs from the
/// hunting motions of points nearby, whose cycle may reach as far as here without a start that leads to it; then the
/// same for the margin. The outcome stays not_judged if it was interrupted.
void judge(TunePoint& point, const TuneQuestion& question, std::span<const MotionState> nearby);

}  // namespace limcycle
