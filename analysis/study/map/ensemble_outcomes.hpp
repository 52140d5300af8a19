#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "limcycle/analysis/lanes/isa.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Result for one loop of many. NaN: no answer.
struct EnsembleOutcome {
  static constexpr std::size_t numbers = 3;
  static constexpr std::string_view names[numbers] = {"hunts", "amplitude", "period"};

  double hunts;      ///< 1: some start ends in a cycle; 0: every start ends without one
  double amplitude;  ///< of the cycle with the largest swing
  double period;     ///< of the same, s
};

/// Settings of the simulations of many loops.
struct EnsembleQuestion {
  std::vector<double> displacements;  ///< of y, one start each
  double amplitude_floor = 1e-9, amplitude_ceiling = 1e6;
  double accuracy = 1e-4;  ///< relative, of amplitude and period
  double rtol = 1e-7;      ///< of the simulations
  Isa isa = best_isa();
  std::function<bool()> stop;
};

/// Settings for a loop: two starts of predict(), displaced by the largest amplitude of interest and by a hundredth of
/// it.
EnsembleQuestion ensemble_question(const Loop& loop);

/// Simulates every loop from every start, in lanes if possible (see run_ensemble), without solving for its cycle: a
/// hundred times cheaper than predict(), and accurate enough for statistics. Empty loops (values without a valid case)
/// and undecided ones have no answer, nor has a loop with one start that ends without a cycle and another that is
/// undecided. The answer to one does not depend on the others. Returns fewer answers than loops only if it was stopped.
std::vector<EnsembleOutcome> ensemble_outcomes(std::span<const std::optional<Loop>> loops,
                                               const EnsembleQuestion& question);

}  // namespace limcycle
