#pragma once
#include <functional>
#include <string>

#include "limcycle/analysis/study/cycle_hunt.hpp"

namespace limcycle {

/// What predictions are worth, found by simulations from the predicted oscillations and by Newton's method near them.
/// Keeps references to all that it is given.
class PredictionCheck {
 public:
  /// The loop as the time domain takes it; `max_steps`: of the integrator, for all checks together. A check that has
  /// begun is finished; predictions that are left then stay undecided and say why.
  PredictionCheck(const Loop& loop, CycleHunt& hunt, long max_steps, const std::function<bool()>& stop);

  /// Sets verdict, cycle and sentence of a prediction of a first-harmonic method. `start`: a state on the predicted
  /// oscillation; `name`: of that start. Cycles met on the way join those of the hunt.
  void check(Prediction& prediction, const LoopState& start, std::string name);

  /// Predictions that were not checked, because the steps were used up.
  int unchecked() const { return unchecked_; }

 private:
  bool stopped() const { return stop_ && stop_(); }
  bool unstable_cycle_near(Prediction& prediction);

  const Loop& loop_;
  CycleHunt& hunt_;
  long last_step_;
  const std::function<bool()>& stop_;
  int unchecked_ = 0;
};

}  // namespace limcycle
