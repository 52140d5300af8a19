#pragma once
#include "limcycle/models/linear/controllers.hpp"

namespace limcycle {

/// A controller at the instants k h, with e_k its input: u_k = C X_k + D e_k, X_(k+1) = A X_k + B e_k. By d/dt ->
/// (1 - z^-1)/h (backward Euler):
///   x_k = (I - h A_c)^-1 (x_(k-1) + h B_c e_k),  u_k = C_c x_k + D_c e_k + D_rate (e_k - e_(k-1))/h.
/// X_k is x_(k-1), the states of the continuous controller in their order, then e_(k-1) if there is a derivative.
/// Stable where the continuous one is; of first order in h. Not finite if 1/h is an eigenvalue of A_c. Cost O(n^3).
StateSpace backward_difference(const ControllerModel& controller, double h);

/// The same for a PID whose derivative is taken over n samples, kd (e_k - e_(k-n))/(n h): X has n past inputs, or n - 1
/// with a filter.
StateSpace windowed_difference(const Pid& pid, double h, int n);

/// (y_k - y_(k-n))/(n h), n >= 1; X holds the last n inputs.
StateSpace difference_over(int n, double h);

/// The continuous controller that acts as that one does, to first order in h and apart from the hold: d/dt -> s/(1 + s
/// h/2), which is (1 - exp(-s h))/h to that order and keeps a stable controller stable. States in the same order, with
/// one more for a derivative. Cost O(n^3).
StateSpace averaged(const ControllerModel& controller, double h);

}  // namespace limcycle
