#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/models/elements.hpp"
#include "limcycle/models/linear/controllers.hpp"
#include "limcycle/models/linear/plants.hpp"

namespace limcycle {

/// What a loop is made of, as a case file says it.
struct LoopParts {
  Plant plant;
  Controller controller;
  std::optional<Element<double>> element;   ///< in series after the controller
  std::optional<Element<double>> friction;  ///< opposes the rubbing velocity of the plant
  std::optional<Element<double>> error;     ///< acts on e = r - y before the controller
  double reference = 0.0;                   ///< set-point r at t = 0
  double reference_rate = 0.0;              ///< dr/dt of a ramp
  double load = 0.0;                        ///< constant force added to the plant's input
};

/// Signals from outside, in the order of the columns below: the constant 1, r, dr/dt, force.
using External = Eigen::Vector4d;
enum ExternalIndex : Eigen::Index { constant_one = 0, reference_value = 1, reference_slope = 2, external_force = 3 };

/// Where element i is connected: input x = C X + D w + c ext, rate v = C_v X + D_v w + c_v ext, with X the linear
/// state, w the outputs of all elements. D is strictly lower triangular over the elements: they are evaluated in order.
/// What the rate owes to X(t - delay) is left out of C_v: no frequency-domain method asks, and in_time_domain() has it.
struct Port {
  Eigen::RowVectorXd C, D, C_v, D_v;
  Eigen::RowVector4d c, c_v;
  Eigen::RowVectorXd C_delayed;  ///< part of the input row that reads X(t - delay)
  /// The set-valued friction law whose choice of sign at v = 0 this element shares (friction compensation).
  std::optional<std::size_t> selection_of;
  bool rubs = false;  ///< x and v are rubbing displacement and velocity: what matters is v, x may move along
  std::string path;   ///< "loop.plant.gravity", "loop.error", "loop.error.rate",
                      ///< "loop.controller.friction_compensation", "loop.controller.saturation", "loop.element",
                      ///< "loop.friction": in this order, if there
};

/// Lur'e form: linear part  dX/dt = A X + A_delayed X(t - delay) + B w + E ext,  y = C_y X,  with nonlinear elements
/// w_i = element_i(x_i, v_i, own state) in feedback. Friction enters with its sign: its column of B is negative.
///
/// States, y and the signals from outside are measured from where the loop rests, `origin`, if it rests at all: a
/// motion of micrometres about a set-point of metres has as many digits as the same motion about zero. With a ramp
/// reference that point moves steadily, origin + origin_rate t, so that cycles about it are periodic.
struct Loop {
  Eigen::MatrixXd A, A_delayed, B;
  Eigen::Matrix<double, Eigen::Dynamic, 4> E;
  Eigen::RowVectorXd C_y;
  std::vector<Element<double>> elements;
  std::vector<Port> ports;
  External external = External::Zero();
  double delay = 0.0;
  Eigen::VectorXd origin, origin_rate;          ///< states of the case are origin + origin_rate t + X; empty: zero
  External external_origin = External::Zero();  ///< signals from outside are these and `external`
  double output_origin = 0.0;                   ///< y of the case is this, ramp_output_rate t, and C_y X
  double ramp_output_rate = 0.0;
  std::vector<std::string> state_names;  ///< as the case writes them; see own_states
  /// The states that state_names name = own_states (origin + X) (see rubbing_coordinates()); empty: origin + X.
  Eigen::MatrixXd own_states;

  Eigen::Index states() const { return A.rows(); }

  /// Closed-loop matrix H(jw) from element outputs w to element inputs x, n_e x n_e, exact with delay. The condition
  /// for a harmonic balance with one element is 1 - N H = 0; the loop's G of the literature is -H. Cost O(n^3).
  Eigen::MatrixXcd element_response(double w) const { return element_response(std::complex<double>(0.0, w)); }
  /// The same at any s off the poles.
  Eigen::MatrixXcd element_response(std::complex<double> s) const;

  /// The same loop with everything measured from its rest point; unchanged where rest_point() is not exact.
  void measure_from_rest();

  /// Response of y to the outputs of the elements, 1 x n_e.
  Eigen::RowVectorXcd output_response(double w) const;

  /// Rest point of the linear part without elements, but with those that pull back (gravity): A X + E ext + B w = 0 in
  /// the least-squares sense; `exact` tells whether it solves the equation. Of several the one near hanging, or where
  /// the elements see least; where a torque is more than gravity can hold, that of the tangent.
  Eigen::VectorXd rest_point(bool& exact) const;
  /// The same of the means of an oscillation: with the mean outputs of the elements given, but for those that pull
  /// back, whose mean outputs are found for a sinusoid of amplitude swings(i) on their input. A X + E ext + B w = 0.
  Eigen::VectorXd mean_point(const Eigen::VectorXd& mean_outputs, const Eigen::VectorXd& swings, bool& exact) const;

  /// A (without delay) with the elements that pull back replaced by their tangents at the rest point; A itself where
  /// there are none.
  Eigen::MatrixXd tangent() const;
};

/// First rule that the combination of parts breaks (relative degree, algebraic loop, ...), or nothing.
/// The key is a path such as "loop.plant".
std::optional<BrokenRule> validate(const LoopParts& parts);

/// Joins the parts. Throws std::invalid_argument with the rule if validate() finds one.
Loop build_loop(const LoopParts& parts);

}  // namespace limcycle
