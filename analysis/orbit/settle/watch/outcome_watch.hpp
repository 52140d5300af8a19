#pragma once
#include <optional>
#include <vector>

#include "limcycle/analysis/motion/march.hpp"
#include "limcycle/analysis/orbit/settle/watch/switching_watch.hpp"

namespace limcycle {

/// The output y over one step from t to t + h, interpolated as in DenseSegment.
struct OutputStep {
  double t = 0.0, h = 0.0;
  double y0 = 0.0, y1 = 0.0;
  double bend[3] = {};

  /// The cubic through the values and rates at both ends.
  static OutputStep through(double t0, double t1, double y0, double y1, double rate0, double rate1);
  /// The same for a step of a march.
  static OutputStep through(const Loop& loop, const Step& step);

  /// y at the fraction theta of the step, and its derivative by theta.
  double value(double theta) const;
  double slope(double theta) const;
  /// Turning point of y, in a step in which its rate changes sign.
  TurningPoints::Point turning() const;
  /// Time at which y reaches `level`, which lies between y0 and y1.
  double crossing(double level) const;
};

/// Decision criteria of the watch of a motion.
struct OutcomeOptions {
  double rtol = 1e-8;             ///< of the march
  double amplitude_floor = 1e-9;  ///< swings of y below this have died out
  /// A cycle is accepted once its swings and its period are expected to change by no more than this share for all time.
  double accuracy = 1e-4;
};

/// Decides the outcome of a motion during its march, from a few numbers: its turning points, the times at which y rises
/// through a level, and occasional samples of the rates. Rest and sliding are recognised as in settle(). A cycle is
/// recognised without shooting: the swings and periods repeat themselves, and the remaining approach, extrapolated from
/// the decrease of the differences between periods, is short. A decay that continues at the same pace is no cycle.
class OutcomeWatch {
 public:
  /// `sizes` and `slow` as for RestWatch. The loop must outlive the watch.
  OutcomeWatch(const Loop& loop, const OutcomeOptions& options, const State& sizes, double slow);

  void begin(double t, double y) { turning_.feed(t, y); }
  /// A step within which the rate of y changes sign.
  void turned(const OutputStep& step);
  /// A step within which y rises through level().
  void crossed(const OutputStep& step);
  /// The state, its rates and the modes of the elements at a time not before next_look().
  void look(double t, const State& x, const State& dx, const std::vector<Mode>& modes);
  /// A step that ended with a switch of element i; the field is in the modes after it.
  void switched(const LoopField& field, const State& x, double t, std::size_t i);
  /// The motion has left all bounds.
  void diverged() { decide(Outcome::divergence); }

  double next_look() const { return stillness_.next(); }
  double level() const { return level_; }  ///< infinite: none is needed

  Outcome outcome() const { return outcome_; }
  bool decided() const { return outcome_ != Outcome::undecided; }
  const std::string& by() const { return by_; }  ///< as in Settled
  /// A cycle whose swings repeated themselves from the start: no approach to it was seen, so it may be one of a family.
  bool doubtful() const { return outcome_ == Outcome::cycle && !approached_; }
  double period() const { return period_; }        ///< s; 0 without a cycle
  double amplitude() const { return amplitude_; }  ///< half the swing of y over one period of the cycle; 0 without
  const TurningPoints& turning() const { return turning_; }

 private:
  void decide(Outcome outcome) {
    if (!decided()) outcome_ = outcome;
  }
  Outcome stillness() const { return slides_at_rest(loop_) ? Outcome::sliding : Outcome::rest; }
  std::size_t repeating() const;
  double difference(std::size_t periods) const;
  std::optional<std::pair<double, double>> last_periods() const;
  void judge();

  const Loop& loop_;
  OutcomeOptions options_;
  StillnessWatch stillness_;
  SwitchingWatch switching_;
  std::string by_;
  bool approached_ = false;  ///< swings were seen to approach their final values
  TurningPoints turning_;
  std::optional<double> rest_y_;  ///< y of the point of rest, once computed; NaN: none
  std::size_t order_ = 0;         ///< turning points per period; 0: the swings do not repeat themselves
  double level_ = infinite;
  std::vector<double> crossings_;  ///< times of the crossings of the present level
  Outcome outcome_ = Outcome::undecided;
  double period_ = 0.0, amplitude_ = 0.0;
};

}  // namespace limcycle
