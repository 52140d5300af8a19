#pragma once
#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>

#include "limcycle/analysis/energy/decision.hpp"
#include "limcycle/analysis/energy/loop/holding_forces.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// All states in which a loop stands still on its friction: A X + B F + E ext = 0, rubbing velocity 0, F a force that
/// the law can hold. A convex piece of an affine space, one dimension for the force and one for each motion without
/// effect on the loop.
struct StuckSet {
  Answer answer;         ///< yes: there are such states; no: none; not_applicable
  int dimension = 0;     ///< -1 if empty; 0: a point
  Extent force, output;  ///< F (N) and y over the set
  bool fixed_output() const { return output.low == output.high; }

  /// yes if motions that begin near come to rest in it. Decided for the part in which the law also stops a sliding body
  /// (see stopping_forces()), at its middle, by the eigenvalues of the linear motion near it.
  Answer attracts;
  Eigen::VectorXcd
      eigenvalues;  ///< of that motion, 1/s, rightmost first: with the bristles, or stuck (the zeros of H_v)
  int winding = 0;  ///< zero eigenvalues beyond the directions of rest: it drifts while it sticks (integral action)

  /// The same by marching from perturbed states: the number tried, and the number that came (back) to rest in the set.
  int tried = 0, returned = 0;
};

/// Options of the check of stuck states.
struct StuckOptions {
  bool march = true;      ///< check by marches
  long max_steps = 4000;  ///< of each march
  std::function<bool()> stop;
};

/// For loops with one friction law and a linear rest without delay, else not_applicable. Cost: O(n^3), and four
/// marches.
StuckSet stuck_set(const Loop& loop, const StuckOptions& options = {});

}  // namespace limcycle
