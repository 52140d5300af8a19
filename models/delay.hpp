#pragma once
#include "limcycle/models/linear/state_space.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// A loop without delay that represents one with delay.
struct TimeDomainLoop {
  Loop loop;
  int pade_order = 0;             ///< 0: exact
  Eigen::Index delay_states = 0;  ///< number of states of the approximation, the last ones of the linear part
};

/// Valid orders of a Pade approximation. At the highest order the error is of rounding size while w delay < 70.
inline constexpr int lowest_pade_order = 1, highest_pade_order = 60;

/// Converts the loop to a form that the time domain can treat:
///  - a loop with a sampled controller becomes Loop::sampled, which is then treated like any other;
///  - a loop without delay, or one that does not use its delayed signals, is unchanged;
///  - a loop in which sampled controllers are all that reads delayed signals is converted exactly: they read without
///    delay, and their outputs come that much later (see Sampled). A controller is then ahead of the plant by the
///    delay;
///  - a loop whose plant is driven through a relay is converted exactly. A DelayedRelay delays the relay's output
///    instead of the plant's, so that the states of the plant, y included, are those of `delay` before; external forces
///    that vary in time (not the load) then act on it `delay` late. Not possible with friction compensation, which
///    reads the present state of the plant;
///  - in any other loop the delay is replaced by its diagonal Pade approximation of the given order, one for each
///    independent delayed signal. States "delay1", ... are appended; if the loop is measured from a rest point, they
///    are at rest there too (see with_constant_history).
/// Measured plants become their fits. The rates of the inputs are recomputed from the states. Throws
/// std::invalid_argument for an order out of range where one is needed, or if an element needs a rate that the
/// approximation makes depend on the element's own output.
TimeDomainLoop in_time_domain(const Loop& loop, int pade_order);

/// The lowest order whose error is at most 1e-9 up to frequency w (rad/s), or the highest.
int pade_order_for(double w, double delay);

/// Linear states of the time-domain loop, its last ones those of the approximation, for states X of the original loop
/// that have been constant for all past time.
Eigen::VectorXd with_constant_history(const Loop& loop, const Eigen::VectorXd& X);
Eigen::VectorXd with_constant_history(const TimeDomainLoop& from, const Eigen::VectorXd& X);

/// The diagonal Pade approximation (m, m) of exp(-s delay), m = order, realised without roots: (1 - T)/(1 + T) with T
/// the m-th convergent of tanh(s delay/2) = x/(2 + x^2/(6 + x^2/(10 + ...))), x = s delay (Lambert 1770), as a ladder
/// of m integrators between lossless junctions. It is all-pass and balanced, A + A' = -C' C/delay and B = -C' D/delay,
/// so that it stays well conditioned at any order; the states have the unit of the signal. delay > 0.
/// Throws std::invalid_argument for a delay or an order out of range.
StateSpace pade_delay(double delay, int order);

/// |exp(-j w delay) - Pade(j w)| = 2 |sin(w delay/2 - atan g)|, T(j w) = j g; for small w delay it grows as
/// (w delay)^(2m+1) (m!)^2/((2m)! (2m+1)!). Absolute accuracy about 1e-16 max(1, w delay).
double pade_error(double w, double delay, int order);

}  // namespace limcycle
