#pragma once
#include <functional>
#include <string>

#include "limcycle/analysis/study/predict/cycle_hunt.hpp"

namespace limcycle {

/// Verdicts on predictions, by simulations from the predicted oscillations and by Newton's method near them. Keeps
/// references to its arguments.
class PredictionCheck {
 public:
  /// The loop for the time domain; `max_steps`: of the integrator, for all simulations together, and as many for the
  /// searches for unstable cycles. What has begun is finished; remaining predictions then stay undecided and give that
  /// reason.
  PredictionCheck(const Loop& loop, CycleHunt& hunt, long max_steps, const std::function<bool()>& stop);

  /// Sets verdict, cycle and sentence of a prediction of a first-harmonic method. `start`: a state on the predicted
  /// oscillation; `name`: of that start. Cycles found on the way join those of the hunt.
  void check(Prediction& prediction, const LoopState& start, std::string name);

  /// Predictions that were not checked, because the step limit was reached.
  int unchecked() const { return unchecked_; }

 private:
  bool stopped() const { return stop_ && stop_(); }
  bool find_unstable(Prediction& prediction);
  bool unstable_cycle_near(Prediction& prediction);

  const Loop& loop_;
  CycleHunt& hunt_;
  long for_simulations_, for_searches_;  ///< steps left
  const std::function<bool()>& stop_;
  int unchecked_ = 0;
};

}  // namespace limcycle
