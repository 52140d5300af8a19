#pragma once
#include <optional>

#include "limcycle/analysis/motion/loop_field.hpp"

namespace limcycle {

/// A steady state of a loop, found from a state near it and checked by substitution.
struct Standstill {
  State x;                ///< where dx/dt = 0, set-valued outputs within their intervals
  double residual = 0.0;  ///< largest rate left there, in sizes of the states per slowest time constant
  double moved = 0.0;     ///< largest change of a state on the way there, in sizes
  bool slides = false;    ///< the body rubs there at a constant speed (on a belt, along a ramp)
};

/// How the algebra of a steady state is scaled.
struct LoopSizes {
  State sizes;        ///< of the states, see typical_sizes()
  double slow = 1.0;  ///< slowest time constant of the linear part, s
};
LoopSizes loop_sizes(const Loop& loop);

/// Does the body rub at x in the present modes, at a speed that is more than rounding (see rubbing_speed)?
bool rubs_at(const LoopField& field, const State& x);

/// Solves dx/dt = 0 by Newton's method from x, in the present modes of the field: those elements that hold a signal
/// keep holding it. Of several solutions the one nearest to x, in sizes. Nothing if there is none, or if an element
/// would leave its mode there (a force beyond what stiction holds).
std::optional<Standstill> standstill_near(LoopField& field, const State& x, const LoopSizes& scale);

/// A steady state that a motion comes to for certain.
struct Approach {
  Standstill to;
  double decay = 0.0;  ///< slowest rate at which what is left decays, 1/s
};

/// Whether the motion from x stays in the present modes and decays: x = x* + sum of modes V_k xi_k exp(lambda_k t) with
/// Re lambda_k < 0, and every guard stays positive since it changes by no more than sum |n V_k| |xi_k|. Directions in
/// which the loop may rest anywhere (friction, a drive) may be neutral, but nothing may wind up in them. Rigorous for
/// piecewise affine elements; for others what is left out of the linear motion must be small against its decay at
/// points all around. Nothing where that is not so.
std::optional<Approach> approach_from(LoopField& field, const State& x, const LoopSizes& scale);

/// Whether a motion with these rates slides for ever at a constant speed, its rates staying as they are (J dx = 0): not
/// with a stuck body, nor under integral action.
bool slides_steadily(LoopField& field, const State& x, const State& dx, const LoopSizes& scale);

}  // namespace limcycle
