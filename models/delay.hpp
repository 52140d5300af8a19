#pragma once
#include "limcycle/models/linear/state_space.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// A loop without delay that stands for one with it.
struct TimeDomainLoop {
  Loop loop;
  int pade_order = 0;             ///< 0: exact
  Eigen::Index delay_states = 0;  ///< the last so many linear states are those of the approximation
};

/// Orders that a Pade approximation may have. With the highest the error is rounding while w delay < 70.
inline constexpr int lowest_pade_order = 1, highest_pade_order = 60;

/// A form of the loop that the time domain can treat:
///  - a loop without delay, or one that does not use what is delayed, as it is;
///  - a loop whose plant is driven through a relay: exactly. The relay's output is delayed instead of the plant's, by a
///    DelayedRelay, so that the states of the plant, y included, are those of `delay` before; forces from outside that
///    vary in time (not the load) then act `delay` late on it. Not with friction compensation, which reads the plant of
///    now;
///  - any other loop: the delay replaced by its diagonal Pade approximation of the given order, one for each
///    independent signal that is read late. States "delay1", ... are appended; where the loop has reached a rest
///    point they are at rest too (see with_constant_history).
/// Rates of inputs are made anew from the states. Throws std::invalid_argument for an order out of range where one is
/// needed, or if an element needs a rate that the approximation makes depend on the element's own output.
TimeDomainLoop in_time_domain(const Loop& loop, int pade_order);

/// Linear states of the time-domain loop that belong to states X of the original one which have been constant for
/// ever.
Eigen::VectorXd with_constant_history(const TimeDomainLoop& from, const Eigen::VectorXd& X);

/// The diagonal Pade approximation (m, m) of exp(-s delay), m = order, realised without roots: (1 - T)/(1 + T) with T
/// the m-th convergent of tanh(s delay/2) = x/(2 + x^2/(6 + x^2/(10 + ...))), x = s delay (Lambert 1770), as a ladder
/// of m integrators between lossless junctions. It is all-pass and balanced, A + A' = -C' C/delay and B = -C' D/delay,
/// so that it stays well conditioned at any order; the states have the unit of the signal. delay > 0.
/// Throws std::invalid_argument for a delay or an order out of range.
StateSpace pade_delay(double delay, int order);

/// |exp(-j w delay) - Pade(j w)| = 2 |sin(w delay/2 - atan g)|, T(j w) = j g; in the beginning it grows as
/// (w delay)^(2m+1) (m!)^2/((2m)! (2m+1)!). Absolute accuracy about 1e-16 max(1, w delay).
double pade_error(double w, double delay, int order);

}  // namespace limcycle
