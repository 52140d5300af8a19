#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/orbit/multiple_shooting.hpp"
#include "limcycle/analysis/study/predict.hpp"

namespace limcycle {

/// What really happens in a loop: the distinct limit cycles found so far, and what was reached from each start.
class CycleHunt {
 public:
  CycleHunt(const Loop& loop, const PredictOptions& options, const SearchBox& box);

  /// Simulates from a state until it is clear what is reached; a cycle reached joins `cycles`.
  const OutcomeOfStart& settle_from(const LoopState& start, std::string name);
  /// The same where no user would start, to learn what lies between the starts: it joins `outcomes` only if it reaches
  /// what none of them has reached, a cycle or another kind of outcome.
  OutcomeOfStart probe_from(const LoopState& start, std::string name);
  /// Newton for the cycle near a guess, stable or not; index of the cycle found (and whether it is near is for the
  /// caller to say).
  std::optional<std::size_t> shoot_from(const OrbitGuess& guess);
  /// The unstable cycle between the smaller and larger oscillations of a family that grow and shrink, each followed for
  /// `max_steps` at most (0: as long as any other motion).
  std::optional<std::size_t> edge_along(const std::function<LoopState(double scale)>& ray, double period,
                                        long max_steps = 0);

  const std::vector<Cycle>& cycles() const { return cycles_; }
  const std::vector<OutcomeOfStart>& outcomes() const { return outcomes_; }
  /// Of the simulations: that of SettleOptions, or less where bristles are too stiff for it.
  double rtol() const { return settle_.rtol; }
  /// Return maps that shooting computed.
  long maps() const { return maps_; }
  /// Steps of the integrator in all that was done.
  long steps() const { return steps_; }

 private:
  OutcomeOfStart simulate(const LoopState& start, std::string name);
  bool is_news(const OutcomeOfStart& outcome) const;
  std::optional<std::size_t> keep(const ShootingResult& shot);

  const Loop& loop_;
  SettleOptions settle_;
  std::vector<Cycle> cycles_;
  std::vector<OutcomeOfStart> outcomes_;
  long maps_ = 0, steps_ = 0;
};

}  // namespace limcycle
