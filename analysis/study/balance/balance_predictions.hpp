#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/balance/first_harmonic_balance.hpp"
#include "limcycle/analysis/study/predict/cycle_hunt.hpp"

namespace limcycle {

/// Predictions of harmonic balance for a loop.
struct BalancePredictions {
  std::vector<Prediction> predictions;  ///< with verdicts
  std::vector<std::string> notes;       ///< starts that gave no solution, and why
  Effort effort;
  bool cut_short = false;  ///< starts remained when the limit of evaluations was reached
  bool interrupted = false;
};

/// Starts and limits of a harmonic balance.
struct BalanceQuestion {
  const Loop& loop;                            ///< with its dead time
  const Loop& in_time;                         ///< the same as simulations use it
  const FirstHarmonicBalance* first_harmonic;  ///< the describing function, if it applies
  const std::vector<Prediction>& predicted;    ///< by the other methods
  long max_evaluations;                        ///< of its equations, for all starts together
  std::function<bool()> stop;
};

/// Harmonic balance from every root of the plain describing function, and from every missed cycle. If no cycle is
/// known, shooting by Newton's method starts from its solutions; cycles found that way join those of the hunt.
BalancePredictions balance_predictions(const BalanceQuestion& question, CycleHunt& hunt);

}  // namespace limcycle
