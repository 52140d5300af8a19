/// @file
/// Odeint's explicit steppers for motion that is not stiff, with the same error norm as RODAS5P.
#pragma once

#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/dense_output_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_cash_karp54.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <utility>

#include "limcycle/analysis/motion/error_weights.hpp"
#include "limcycle/analysis/motion/state.hpp"

namespace limcycle {

/// Controlled steppers of Odeint with WeightedErrorChecker. Their system is the right side alone, f(x, dxdt, t).
/// The cost of LuGre friction grows as sigma0 with them (stability), so take RODAS5P when sigma0 v_max / Fc is above
/// about 1e3 1/s. ControlledDopri5 and DenseDopri5 keep f at the end of a step for the next: call reset() (initialize()
/// for the dense one) whenever the system changes or the state jumps.
///
/// A try_step so short that t + dt == t counts as a success in Odeint (and the integrate functions then never end): a
/// user's own loop should check for it. ControlledRodas5p rejects such a step.
template <class Stepper>
using Weighted = boost::numeric::odeint::controlled_runge_kutta<Stepper, WeightedErrorChecker>;

/// Dormand and Prince 5(4), 6 evaluations a step.
using ControlledDopri5 = Weighted<boost::numeric::odeint::runge_kutta_dopri5<State>>;
/// The same with dense output of order 4.
using DenseDopri5 = boost::numeric::odeint::dense_output_runge_kutta<ControlledDopri5>;
/// Fehlberg 8(7), 13 evaluations a step.
using ControlledFehlberg78 = Weighted<boost::numeric::odeint::runge_kutta_fehlberg78<State>>;
/// Cash and Karp 5(4), 6 evaluations a step.
using ControlledCashKarp54 = Weighted<boost::numeric::odeint::runge_kutta_cash_karp54<State>>;

/// A controlled stepper with these tolerances and steps of at most max_dt (0: no limit). Throws std::invalid_argument
/// if the weights are not valid.
template <class Controlled>
Controlled make_controlled(ErrorWeights weights, double max_dt = 0) {
  return Controlled(WeightedErrorChecker(std::move(weights)), typename Controlled::step_adjuster_type(max_dt));
}

inline ControlledDopri5 make_dopri5(ErrorWeights weights, double max_dt = 0) {
  return make_controlled<ControlledDopri5>(std::move(weights), max_dt);
}
inline DenseDopri5 make_dense_dopri5(ErrorWeights weights, double max_dt = 0) {
  return DenseDopri5(make_dopri5(std::move(weights), max_dt));
}
inline ControlledFehlberg78 make_fehlberg78(ErrorWeights weights, double max_dt = 0) {
  return make_controlled<ControlledFehlberg78>(std::move(weights), max_dt);
}
inline ControlledCashKarp54 make_cash_karp54(ErrorWeights weights, double max_dt = 0) {
  return make_controlled<ControlledCashKarp54>(std::move(weights), max_dt);
}

}  // namespace limcycle
