#pragma once
#include <algorithm>

#include "limcycle/analysis/motion/state.hpp"
#include "limcycle/analysis/orbit/settle/watch/turning_points.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Watches if a motion dies out, by samples at least the slowest time constant and a third of the time since the start,
/// or since the last switch, apart. Rest shows by either of two signs, three times in a row:
/// - the displacement that the rates would cause in the same time again fades, compared with the size of the state.
///   Rates as small as the noise of the integration count as none.
/// - on the mean since the last sample, no rate is more than that noise, and nothing has switched. A body at rest on a
///   bristle may tremble, and even creep, for ever within the tolerances, with momentary rates that are those of the
///   bristle. (A cycle with long stick has few steps, and samples of it may all fall on the same switch.)
/// A body that sticks while an integrator winds up shows neither: in its slowest time constant, the integrator moves by
/// a good part of its size.
class RestWatch {
 public:
  /// `sizes`: of the states, see typical_sizes(); `slow`: slowest time constant of the linear part, s.
  RestWatch(State sizes, double slow, double rtol) : sizes_(std::move(sizes)), slow_(slow), rtol_(rtol) {}

  enum class Verdict { moving, steady, at_rest };

  /// Call after every step, or after those that end at or after next(). steady: the rates have become constant, though
  /// not zero.
  Verdict look(double t, const State& x, const State& dx);
  double next() const { return next_; }
  /// A body stuck behind a winding integrator may wait for millions of time constants. What it does once it breaks away
  /// is looked at on the scale of that motion, not of the wait.
  void switched(double t) {
    since_ = t;
    still_ = 0;
    next_ = std::min(next_, t + slow_);
  }
  double since() const { return since_; }  ///< time of the last switch
  /// The largest of the rates, in sizes per slowest time constant.
  double rate(const State& dx) const;
  double rtol() const { return rtol_; }          ///< of the simulation
  double noise() const { return 0.01 * rtol_; }  ///< rates as small as that count as none

 private:
  State sizes_;
  double slow_, rtol_, since_ = 0.0, next_ = 0.0, last_ = infinite;
  bool rates_constant(const State& dx);
  bool rates_fade(double t, const State& dx);
  bool stays(double t, const State& x);

  double looked_ = 0.0;
  State rates_before_, before_;
  int calm_ = 0, still_ = 0, steady_ = 0;
};

/// Speed above which a friction law counts as rubbing: a hundredth of its own scale, or for a law without one 1e-8 of
/// the typical velocities of the loop; infinite if nothing rubs.
double rubbing_speed(const Loop& loop);

/// True if the body rubs steadily while the loop stands still (a belt, a ramp).
bool slides_at_rest(const Loop& loop);

/// Stick-slip that decays for ever: the last swings are below `floor`, about the point of rest (y = rest), smaller and
/// smaller, and farther and farther apart in time. (The tremble of a bristle when the body stops is small too, but its
/// swings follow one another at once, and the next slip may come much later.) Needs 5 turning points.
bool died_out(const TurningPoints& turning, double rest, double floor);

}  // namespace limcycle
