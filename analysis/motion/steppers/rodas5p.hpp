/// @file
/// One step of RODAS5P, the implicit method for stiff motion (mainly friction with a stiff bristle).
#pragma once

#include <Eigen/Core>
#include <boost/numeric/odeint/stepper/stepper_categories.hpp>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "limcycle/analysis/motion/state.hpp"
#include "limcycle/analysis/motion/steppers/dense_segment.hpp"
#include "limcycle/analysis/motion/steppers/rodas5p_tableau.hpp"

namespace limcycle {

/// The object itself, or the target of a std::reference_wrapper (Odeint users pass systems as std::ref).
template <class T>
T& unwrap(T& value) {
  return value;
}
template <class T>
T& unwrap(std::reference_wrapper<T>& value) {
  return value.get();
}
template <class T>
T& unwrap(const std::reference_wrapper<T>& value) {
  return value.get();
}

/// RODAS5P (Steinebach 2023): Rosenbrock method of 8 stages, order 5 with an embedded solution of order 4, L-stable and
/// stiffly accurate, for x' = f(x, t). A step solves 8 linear systems with one LU factorisation and calls f 8 times and
/// the Jacobian once.
///
/// Shape: Odeint's error stepper for an implicit system, as odeint::rosenbrock4. `System` is a std::pair or anything
/// with
/// - `first(x, dxdt, t)`: the right side; dxdt has the size of x;
/// - `second(x, J, t, dfdt)`: J(i, j) = df_i/dx_j (Eigen::MatrixXd) and dfdt = partial df/dt (State). Both have their
/// size
///   and are zero on entry, so that only nonzero entries need be written.
/// The pair and its parts may be std::ref. J must be the exact Jacobian: the order falls to 1 otherwise.
///
/// No error of f or J (NaN, singular matrix) stops a step: it makes xout or xerr NaN or infinite, which
/// ErrorWeights::norm detects. No heap allocation after the first step of a given size. A copy is independent.
class Rodas5p {
 public:
  using state_type = State;
  using deriv_type = State;
  using value_type = double;
  using time_type = double;
  using order_type = unsigned short;
  using stepper_category = boost::numeric::odeint::error_stepper_tag;

  static constexpr order_type stepper_order = 5;
  static constexpr order_type error_order = 4;  ///< of the embedded solution; the error estimate is O(dt^5)
  order_type order() const { return stepper_order; }

  /// Step of length dt (not 0, negative runs back) from (x, t): solution of order 5 in xout, its difference from the
  /// embedded one in xerr. xout may be x.
  template <class System>
  void do_step(System&& system, const State& x, double t, State& xout, double dt, State& xerr) {
    begin(x, t);
    unwrap(unwrap(system).first)(std::as_const(x0_), f0_, t);
    linearise(system);
    advance(system, xout, dt, xerr);
  }
  /// The same with the rate at (x, t) given, as Odeint's explicit steppers take it: one call of f less.
  template <class System>
  void do_step(System&& system, const State& x, const State& dxdt, double t, State& xout, double dt, State& xerr) {
    begin(x, t);
    f0_ = dxdt;
    linearise(system);
    advance(system, xout, dt, xerr);
  }
  template <class System>
  void do_step(System&& system, const State& x, double t, State& xout, double dt) {
    do_step(system, x, t, xout, dt, unused_error_);
  }
  template <class System>
  void do_step(System&& system, State& x, double t, double dt, State& xerr) {
    do_step(system, x, t, x, dt, xerr);
  }
  template <class System>
  void do_step(System&& system, State& x, double t, double dt) {
    do_step(system, x, t, x, dt, unused_error_);
  }

  /// The step from the start of the last step with another dt: f, J and df/dt are not evaluated there again. Correct
  /// only while the system is unchanged (same mode, same parameters). A step must have been taken.
  template <class System>
  void repeat_step(System&& system, State& xout, double dt, State& xerr) {
    advance(system, xout, dt, xerr);
  }

  /// Start of the last step.
  const State& start_state() const { return x0_; }
  double start_time() const { return t0_; }

  /// Interpolant of the last step, accepted or not. Costs about as much as two stages without f.
  void interpolant(DenseSegment& segment) const;

  /// Makes room for states of the size of x.
  void adjust_size(const State& x) { resize(x.size()); }

 private:
  /// The right side of any system: the stages are compiled once, in their own file.
  struct RightSide {
    void* system;
    void (*rate)(void* system, const State& x, State& dxdt, double t);
  };

  void begin(const State& x, double t);

  template <class System>
  void linearise(System& system) {
    jacobian_.setZero();
    dfdt_.assign(x0_.size(), 0.0);
    unwrap(unwrap(system).second)(std::as_const(x0_), jacobian_, t0_, dfdt_);
    find_moving();
  }

  template <class System>
  void advance(System& system, State& xout, double dt, State& xerr) {
    auto& f = unwrap(unwrap(system).first);
    auto call = [&f](const State& x, State& dxdt, double t) { f(x, dxdt, t); };
    run({&call, [](void* object, const State& x, State& dxdt,
                   double t) { (*static_cast<decltype(call)*>(object))(x, dxdt, t); }},
        dt);
    finish(xout, xerr);
  }

  void resize(std::size_t n);
  void find_moving();
  void run(const RightSide& f, double h);
  template <int N>
  void run_sized(const RightSide& f, double h);
  template <int N, std::size_t s>
  void stage(const RightSide& f);
  template <int N>
  void factorise();
  template <int N>
  void solve(double* solution);
  void finish(State& xout, State& xerr);

  State x0_, f0_, dfdt_, x1_, stage_x_, stage_f_, right_, unused_error_;
  Eigen::MatrixXd jacobian_;
  std::vector<double> k_;  ///< the stages, one after the other
  /// I/(gamma h) - J by columns, factorised or inverted, and its rows in the order of the pivots.
  std::vector<double> lu_;
  std::vector<std::size_t> order_;
  /// Of a large system: the states whose row of the Jacobian is not zero. Only they have a system to solve.
  std::vector<std::size_t> moving_;
  State solved_;  ///< its solution
  double t0_ = 0;
  double h_ = 0;
};

}  // namespace limcycle
