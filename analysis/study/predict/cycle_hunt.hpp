#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/orbit/cycle/multiple_shooting.hpp"
#include "limcycle/analysis/study/predict/predict.hpp"

namespace limcycle {

/// The true behaviour of a loop: the distinct limit cycles found so far, and the outcome of each start.
class CycleHunt {
 public:
  CycleHunt(const Loop& loop, const PredictOptions& options, const SearchBox& box);

  /// Simulates from a state until the outcome is decided; a cycle reached or passed joins `cycles`.
  const OutcomeOfStart& settle_from(const LoopState& start, std::string name);
  /// The same from a state that no user would choose, to find outcomes between the starts: it joins `outcomes` only if
  /// it reaches a cycle or another kind of outcome that none of them has reached. A motion whose swings have become
  /// less than `smallest_swing` has died out.
  OutcomeOfStart probe_from(const LoopState& start, std::string name, double smallest_swing = 0.0);
  /// Newton's method for the cycle near a guess, stable or not; index of the cycle found (the caller decides if it is
  /// near).
  std::optional<std::size_t> shoot_from(const OrbitGuess& guess);
  /// The unstable cycle between the smaller and larger oscillations of a family that shrink and grow, if the smallest
  /// and the largest end differently.
  std::optional<std::size_t> edge_along(const std::function<LoopState(double scale)>& ray, double period);
  /// The same where it is known that they do.
  std::optional<std::size_t> edge_between(const std::function<LoopState(double scale)>& ray, double period);

  const std::vector<Cycle>& cycles() const { return cycles_; }
  const std::vector<OutcomeOfStart>& outcomes() const { return outcomes_; }
  /// Tolerance of the simulations: that of SettleOptions, or less if bristles are too stiff for it.
  double rtol() const { return settle_.rtol; }
  /// Swings of y below this are of no interest.
  double smallest_swing() const { return settle_.amplitude_floor; }
  /// Return maps that shooting computed.
  long maps() const { return maps_; }
  /// Steps of the integrator in all computations.
  long steps() const { return steps_; }

 private:
  OutcomeOfStart simulate(const LoopState& start, std::string name);
  bool is_news(const OutcomeOfStart& outcome) const;
  std::optional<std::size_t> keep(const ShootingResult& shot);

  const Loop& loop_;
  SettleOptions settle_;
  std::vector<Cycle> cycles_;
  std::vector<IrregularMotion> irregular_;
  std::vector<OutcomeOfStart> outcomes_;
  long maps_ = 0, steps_ = 0;
};

}  // namespace limcycle
