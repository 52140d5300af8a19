#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/models/element/of_controllers/sampled.hpp"

namespace limcycle {

/// A body that is stuck while sampled controllers wind up may wait for millions of samples, between which nothing moves
/// and from which to which every state changes by the same amount. Most of them are leapt over: x + m d and t + m T, T
/// being the time after which the clocks are as they were, d the change in it.
///
/// The change is the mean over 32 times T, each of which must have had it, to 1e-9 of it and what roundings explain; as
/// must the last T before every further leap. A leap is at most as long as all the wait before it, and ends several T
/// before the first guard that falls, at the rate observed, could be zero, or an output at its limit or at its next
/// quantum. Error: that of the sum m d, a rounding of the state a leap (sample by sample there is one a sample). Never
/// leapt over are waits in which a quantized input moves, or an element is neither held nor affine in its mode.
class ClockWait {
 public:
  /// Of a loop with sampled controllers.
  explicit ClockWait(const Loop& loop);

  /// Something else than clocks moved.
  void interrupt() { repetitions_ = none; }

  struct Leap {
    State x;
    double t = 0.0;
  };
  /// At a point from which nothing but clocks run, with the guards there; not beyond t_end.
  std::optional<Leap> look(const LoopField& field, const State& x, double t, const std::vector<double>& guards,
                           double t_end);

 private:
  static constexpr int none = -1;

  void begin(const LoopField& field, const State& x, double t);
  void observe(const LoopField& field, const std::vector<double>& guards);
  bool is_affine(const LoopField& field) const;
  State term_sizes(const LoopField& field, const State& x) const;
  bool goes_on(const LoopField& field, const State& x) const;
  std::pair<double, double> next_output(const Sampled<double>& sampled, double input, std::size_t first,
                                        const State& x) const;
  double spare() const { return 4.0 + catch_up_; }  ///< repetitions left before a guard
  double room(const LoopField& field, const State& x) const;
  Leap over(const State& x, double t, double times);

  const Loop& loop_;
  double repetition_;
  int catch_up_ = 1;           ///< repetitions after which an output is that of a reading after the leap
  std::vector<double> quiet_;  ///< guards of the elements without a clock
  int repetitions_ = none;     ///< since the wait, or the last leap, began
  double trusted_ = 0.0;       ///< repetitions that had the same change
  double t_ = 0.0;
  State x_, first_x_, change_;
  std::vector<Mode> modes_;
  std::vector<double> inputs_, first_guards_, slopes_;
  std::vector<double> guards_;  ///< at the last repetition; none after a leap
  std::vector<double> lowest_;  ///< guards since the last repetition
};

}  // namespace limcycle
