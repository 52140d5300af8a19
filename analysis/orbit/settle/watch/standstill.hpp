#pragma once
#include <optional>

#include "limcycle/analysis/motion/field/loop_field.hpp"

namespace limcycle {

/// A steady state of a loop, found from a state near it and checked by substitution.
struct Standstill {
  State x;                ///< where dx/dt = 0, set-valued outputs within their intervals
  double residual = 0.0;  ///< largest remaining rate, in sizes of the states per slowest time constant
  double moved = 0.0;     ///< largest change of a state from the given one, in sizes
  bool slides = false;    ///< the body rubs there at a constant speed (on a belt, along a ramp)
};

/// Scales for the algebra of a steady state.
struct LoopSizes {
  State sizes;        ///< of the states, see typical_sizes()
  double slow = 1.0;  ///< slowest time constant of the linear part, s
};
LoopSizes loop_sizes(const Loop& loop);

/// True if a body sticks, by a law that holds it.
bool is_stuck(const LoopField& field);
/// True if the body rubs at x in the present modes, at a speed above rounding (see rubbing_speed).
bool rubs_at(const LoopField& field, const State& x);

/// Solves dx/dt = 0 by Newton's method from x, in the present modes of the field: elements that hold a signal keep
/// holding it. Of several solutions it returns the one nearest to x, in sizes. Nothing if there is none, or if an
/// element would leave its mode there (a force beyond what stiction holds).
std::optional<Standstill> standstill_near(LoopField& field, const State& x, const LoopSizes& scale);

/// A steady state that a motion certainly approaches.
struct Approach {
  Standstill to;
  double decay = 0.0;  ///< slowest rate at which the remaining deviation decays, 1/s
};

/// The steady state x* if the motion from x stays in the present modes and decays: x = x* + sum of modes V_k xi_k
/// exp(lambda_k t) with Re lambda_k < 0, and every guard stays positive since it changes by no more than sum |n V_k|
/// |xi_k|. Directions in which the loop may rest anywhere (friction, a drive) may be neutral, but nothing may wind up
/// in them. Rigorous for piecewise affine elements; for others the nonlinear remainder must be small against the decay
/// at points all around. Nothing otherwise.
std::optional<Approach> approach_from(LoopField& field, const State& x, const LoopSizes& scale);

/// True if a motion with these rates slides for ever at a constant speed, with constant rates (J dx = 0); false for a
/// stuck body and under integral action.
bool slides_steadily(LoopField& field, const State& x, const State& dx, const LoopSizes& scale);

/// True if y and the rubbing body stand still for ever while other states grow at the constant rates dx: a body held by
/// friction behind a limited command, whose integrator winds up. No guard may ever fire on the way.
bool held_while_winding_up(LoopField& field, const State& x, const State& dx, const LoopSizes& scale);

}  // namespace limcycle
