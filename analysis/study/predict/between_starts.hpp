#pragma once
#include <functional>
#include <vector>

#include "limcycle/analysis/study/predict/cycle_hunt.hpp"

namespace limcycle {

/// Places between two displacements, the larger first, at ratios of about five: a motion may begin from there alone.
std::vector<double> places_between(double low, double high);

/// Searches for cycles between the starts of a hunt, if it is known that the starts of a loop end differently. Keeps
/// references to its arguments. Cost: some simulations for each border.
class BetweenStarts {
 public:
  /// `max_steps`: of the integrator, for all calls of this object; a simulation that has begun is finished.
  BetweenStarts(const Loop& loop, CycleHunt& hunt, long max_steps, const std::function<bool()>& stop);

  /// Starts along one ray of initial states, by their position on it (positive), and the index of their outcome.
  struct Start {
    double place;
    std::size_t outcome;
  };
  /// A place on the ray of the starts as a state, and its text.
  struct Ray {
    std::function<LoopState(double place)> state;
    std::function<std::string(double place)> name;
  };
  /// Between neighbouring starts of which one diverges and the other does not, the border is bisected (in the logarithm
  /// of the position) and every motion on the way followed to its end, unless an unstable cycle is known there. Between
  /// neighbours that both come to rest or slide, motions begin at a ratio of about five and are followed until they
  /// swing less than the lower neighbour: a stable cycle may lie between. One motion more begins at a fifth of the
  /// lowest start if that came to rest: from smaller displacements a body does not slide to its set-point, but waits
  /// for the integrator. If that one rests too and a body may stick, the last begins next to the set-point: only from
  /// there does it reach hunting that is far finer than any start.
  void look_between(std::vector<Start> starts, const Ray& ray);

  /// Simulates from just inside and just outside every unstable cycle not treated before (1 % nearer to the rest point
  /// of the linear part and 1 % farther from it): the cycle is the border between the outcomes of these two. Returns
  /// the cycles from which neither was decided.
  std::vector<std::size_t> look_beside_unstable_cycles();

 private:
  bool over() const { return left_ <= 0 || (stop_ && stop_()); }
  OutcomeOfStart probe(const LoopState& start, std::string name, double smallest_swing = 0.0);
  bool knows_border(const Start& low, const Start& high) const;
  bool find_border(double low, double high, const Trace& diverging, const Ray& ray);
  void bisect_divergence(const Start& low, const Start& high, const Ray& ray);

  const Loop& loop_;
  CycleHunt& hunt_;
  long left_;  ///< steps
  const std::function<bool()>& stop_;
  std::size_t looked_at_ = 0;  ///< number of cycles treated
};

}  // namespace limcycle
