#pragma once
#include <functional>
#include <vector>

#include "limcycle/analysis/study/cycle_hunt.hpp"

namespace limcycle {

/// Looks for what the starts of a hunt have passed by, where it is known that a loop does not do the same from
/// everywhere. Keeps references to all that it is given. Cost: some simulations for each border.
class BetweenStarts {
 public:
  /// `max_steps`: of the integrator, for all that is asked of this object; a simulation that has begun is finished.
  BetweenStarts(const Loop& loop, CycleHunt& hunt, long max_steps, const std::function<bool()>& stop);

  /// Starts along one ray of initial states, by their place on it (positive), and the index of their outcome.
  struct Start {
    double place;
    std::size_t outcome;
  };
  /// Between neighbouring starts of which one diverges and the other does not, the border is bisected (in the logarithm
  /// of the place) and every motion on the way followed to its end. `name`: of a start at a place, in words.
  void look_inside_divergence(std::vector<Start> starts, const std::function<LoopState(double place)>& ray,
                              const std::function<std::string(double place)>& name);

  /// The unstable cycles at the borders found, where no other method has shown any: they join the cycles of the hunt.
  /// Cost: some fifty short simulations for each border.
  void find_borders();

  /// From just inside and just outside every unstable cycle (1 % nearer to the rest point of the linear part and
  /// farther from it) for which that was not done before: it is the border between what these two lead to. Returns the
  /// cycles from which neither was decided.
  std::vector<std::size_t> look_beside_unstable_cycles();

 private:
  bool over() const { return left_ <= 0 || (stop_ && stop_()); }
  OutcomeOfStart probe(const LoopState& start, std::string name);

  /// Where motions begin to diverge, and how long one of them took to go round there.
  struct Border {
    std::function<LoopState(double scale)> ray;  ///< 1: at the border
    double period;                               ///< s
  };

  const Loop& loop_;
  CycleHunt& hunt_;
  long left_;  ///< steps
  const std::function<bool()>& stop_;
  std::size_t looked_at_ = 0;  ///< cycles
  std::vector<Border> borders_;
};

}  // namespace limcycle
