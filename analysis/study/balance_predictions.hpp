#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/cycle_hunt.hpp"
#include "limcycle/analysis/study/loop_balance.hpp"

namespace limcycle {

/// What harmonic balance predicts of a loop.
struct BalancePredictions {
  std::vector<Prediction> predictions;  ///< with verdicts
  std::vector<std::string> notes;       ///< starts from which it came to nothing, and why
  Effort effort;
  bool cut_short = false;  ///< starts were left when the evaluations were used up
  bool interrupted = false;
};

/// Where a harmonic balance begins, and what it costs.
struct BalanceQuestion {
  const Loop& loop;                          ///< with its dead time
  const Loop& in_time;                       ///< the same as simulations take it
  const LoopBalance* first_harmonic;         ///< the describing function, if it applies
  const std::vector<Prediction>& predicted;  ///< by the other methods
  long max_evaluations;                      ///< of its equations, for all starts together
  std::function<bool()> stop;
};

/// Harmonic balance from every root of the plain describing function, and from every cycle it missed. Newton's method
/// begins from what it finds where no cycle is known; cycles found that way join those of the hunt.
BalancePredictions balance_predictions(const BalanceQuestion& question, CycleHunt& hunt);

}  // namespace limcycle
