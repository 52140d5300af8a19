#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/analysis/orbit/settle/watch/rest_watch.hpp"
#include "limcycle/analysis/orbit/settle/watch/standstill.hpp"

namespace limcycle {

/// A motion that has come to rest or to steady sliding.
struct Stillness {
  Outcome outcome = Outcome::rest;
  std::string why;   ///< one sentence
  std::string by{};  ///< "switching": through ever faster switching; else empty
};

/// Watches if a motion comes to rest or slides for ever, by samples as for RestWatch. A verdict from the rates counts
/// only once the equations of the loop hold: a state of rest near the motion solves dx/dt = 0 with every set-valued
/// output within its interval, and a steady slide keeps its rates (J dx = 0). A decay too slow for its rates to die out
/// counts as rest once the motion can no longer leave the linear decay (see approach_from). A body that sticks, however
/// near to the set-point, does not rest while an integrator winds up to its break-away; but one that creeps to the
/// set-point sticks at last by the error of the integration, and what winds it up is that error: it rests if it has
/// stuck for a million of the loop's slowest time constants, and its rates are within that error.
class StillnessWatch {
 public:
  /// The loop must outlive the watch.
  StillnessWatch(const Loop& loop, State sizes, double slow, double rtol);

  double next() const { return rest_.next(); }
  /// The state, its rates and the modes at a time not before next(), or after every step.
  std::optional<Stillness> look(double t, const State& x, const State& dx, const std::vector<Mode>& modes);
  /// In place of look(), of a loop with a sampled controller: after the clock of an element has switched. Rates are the
  /// changes of the state from one reading to the next; it rests once they fade, and slides once they are steady.
  std::optional<Stillness> read(double t, const State& x, const LoopField& field);
  /// After a switch: see RestWatch::switched.
  void restart(double t) { rest_.switched(t); }
  /// The same, with a look at it: the time of a switch, and the state and the rates after it. A body that creeps to
  /// rest at the edge of stiction finally sticks and breaks away by rounding: it rests once the rates vanish after many
  /// switches in a row. A body that trembles for ever within the tolerances, in loops too small for the return points
  /// that a law can keep, rests once many switches in a row leave plant and controller where they are.
  std::optional<Stillness> switched(double t, const State& x, const State& dx);
  /// The same if the march itself stopped because its switches accumulate.
  std::optional<Stillness> within_rounding(const State& dx) const;

 private:
  Stillness but_for_switching() const;
  bool trembles(double t, const State& x);
  std::optional<Stillness> at_rest(LoopField& field, const State& x, const State& dx) const;

  const Loop& loop_;
  LoopSizes scale_;
  RestWatch rest_;
  int looks_ = 0, idle_ = 0;
  double next_algebra_ = 0.0;
  State read_;  ///< the state at the last reading, and its time
  double read_at_ = 0.0;
  State about_;  ///< the state at the first of the last switches that left it there, its time, and their number
  double about_since_ = 0.0;
  int about_times_ = 0;
};

}  // namespace limcycle
