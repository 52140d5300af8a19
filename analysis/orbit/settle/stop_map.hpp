#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/motion/error_weights.hpp"
#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// The map from one position of rest to the next, of a loop whose last element holds a body at rest, truly or by
/// bristles that yield a little, until a controller with integral action breaks it away: a limit cycle that sticks is a
/// fixed point of it (Armstrong-Helouvry, Dupont and Canudas de Wit 1994, Automatica 30(7), section 5, of servos under
/// PID). One flight takes some tens of steps, so that the map finds ranges of attraction that no few starts fall into.
class StopMap {
 public:
  /// Empty if no body sticks, or if nothing winds up in the loop with the body held, steadily or towards a limit (a
  /// leak), from where no force acts on it.
  static std::optional<StopMap> of(const Loop& loop, double rtol, std::function<bool()> stop);
  static std::optional<StopMap> of(Loop&& temporary, double rtol, std::function<bool()> stop) = delete;

  /// The loop long held with y displaced from its rest point by p, as it winds up, when no force acts on the body.
  LoopState held_at(double p) const;
  /// |p'|/p, p' the displacement at which the body that breaks away from p next sticks; empty if it does not within
  /// some thousand steps. `p` > 0.
  std::optional<double> ratio(double p);
  /// Displacements between `least` and `most` from which the swings grow while they shrink from a larger one close by,
  /// or do not follow from it at all, and one hardly above the stable cycle that lies between the two. Cost: about ten
  /// flights a decade and ten for each maximum close to 1 and each jump.
  std::vector<double> growing(double least, double most);
  long steps() const { return steps_; }

 private:
  StopMap(const Loop& loop, double rtol, std::function<bool()> stop);
  std::optional<double> growing_between(double low, double high);
  double growing_below_jump(double low, double high);
  double shrinking_above(double low, double high);
  std::optional<double> growing_above_jump(double low, double high, double upper, double rise, double lower);
  /// True at the end of a step at which the body that has broken away is held again: a body on bristles where its
  /// velocity changes sign.
  bool stops(const LoopField& field, const State& x);

  struct Flight {
    double from;  ///< rubbing displacement
    bool moved;
    double v;
  };

  const Loop* loop_;
  ErrorWeights weights_;
  std::function<bool()> stop_;
  Eigen::VectorXd rest_, held_;  ///< linear states of the rest point, and their change per unit of displacement
  std::optional<Flight> flight_;
  long steps_ = 0;
};

}  // namespace limcycle
