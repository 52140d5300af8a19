#pragma once
#include <Eigen/Core>
#include <complex>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/models/diagram/diagram.hpp"

namespace limcycle {

/// Parts of a loop, as in a case file: five slots or, if that is present, a diagram in their place.
struct LoopParts {
  Plant plant;
  Controller controller;
  std::optional<Element> element;    ///< in series after the controller
  std::optional<Element> friction;   ///< opposes the rubbing velocity of the plant
  std::optional<Element> error;      ///< acts on e = r - y before the controller
  double reference = 0.0;            ///< set-point r at t = 0
  double reference_rate = 0.0;       ///< dr/dt of a ramp
  double load = 0.0;                 ///< constant force added to the plant's input
  std::optional<Diagram> diagram{};  ///< the slots above are then empty, but for the reference
};

/// External signals, in the order of the columns below: the constant 1, r, dr/dt, force.
using External = Eigen::Vector4d;
enum ExternalIndex : Eigen::Index { constant_one = 0, reference_value = 1, reference_slope = 2, external_force = 3 };

/// The nonlinear element that a question about one element is about: the friction law; without one the element in
/// series, then the one on the error. Of a diagram the only friction law, else the only element; null if there are
/// several.
struct Subject {
  const Element* element = nullptr;
  std::string path;
  bool opposes = false;  ///< friction on a body
};
Subject subject_of(const LoopParts& parts);

/// Connections of element i: input x = C X + D w + c ext, rate v = C_v X + D_v w + c_v ext, with X the linear state, w
/// the outputs of all elements. D is strictly lower triangular over the elements: they are evaluated in order. C_v
/// omits the dependence on X(t - delay): no frequency-domain method uses it, and in_time_domain() restores it.
struct Port {
  Eigen::RowVectorXd C, D, C_v, D_v;
  Eigen::RowVector4d c, c_v;
  Eigen::RowVectorXd C_delayed;  ///< part of the input row that reads X(t - delay)
  /// The set-valued friction law whose selection at v = 0 this element shares: a friction compensation, or another
  /// friction law at the same body, which sticks and breaks away with it (their forces at rest have a known sum only).
  std::optional<std::size_t> selection_of;
  bool reversed = false;  ///< it measures the velocity in the other direction
  bool rubs = false;      ///< x and v are rubbing displacement and velocity: v matters, x may drift
  bool opposes = false;   ///< a friction law that opposes that velocity: these are the last elements of a loop
  std::string path;       ///< "loop.plant.gravity", "loop.error", "loop.error.rate",
                          ///< "loop.controller.friction_compensation", "loop.controller.saturation", "loop.element",
                          ///< "loop.friction": in this order, if present; of a diagram "diagram.NAME"
};

/// A plant of the loop that is known by measured data: its states are those of a fit. In the frequency domain its input
/// C X + C_delayed X(t - delay) + D w, friction included, acts with the factor response->ratio(w), which makes the
/// plant that of the data, times `factor`, by which a derivative with respect to the data is taken.
struct MeasuredPart {
  std::string path;  ///< "loop.plant", "diagram.NAME"
  std::shared_ptr<const MeasuredResponse> response;
  Eigen::VectorXd B;  ///< through which that input acts on the states
  Eigen::RowVectorXd C, C_delayed, D;
  std::complex<double> factor = 1.0;
};

/// Lur'e form: linear part  dX/dt = A X + A_delayed X(t - delay) + B w + E ext,  y = C_y X,  with nonlinear elements
/// w_i = element_i(x_i, v_i, own state) in feedback. Friction enters with its sign: its column of B is negative.
///
/// States, y and the external signals are measured from the rest point, `origin`, if there is one: a motion of
/// micrometres about a set-point of metres has as many digits as the same motion about zero. With a ramp reference that
/// point moves steadily, origin + origin_rate t, so that cycles about it are periodic.
struct Loop {
  Eigen::MatrixXd A, A_delayed, B;
  Eigen::Matrix<double, Eigen::Dynamic, 4> E;
  Eigen::RowVectorXd C_y;
  std::vector<Element> elements;
  std::vector<Port> ports;
  External external = External::Zero();
  double delay = 0.0;
  Eigen::VectorXd origin, origin_rate;          ///< states of the case are origin + origin_rate t + X; empty: zero
  External external_origin = External::Zero();  ///< external signals are these plus `external`
  double output_origin = 0.0;                   ///< y of the case is the sum of this, ramp_output_rate t and C_y X
  double ramp_output_rate = 0.0;
  std::vector<std::string> state_names;  ///< as written in the case; see own_states
  /// Of a loop with a sampled controller: the same loop as it moves, its controller an element with a clock (see
  /// Sampled). This one has the continuous controller that acts as it does on average, and the dead time of hold and
  /// computation: it is right to first order in the sample time. Its responses are those of the sampled controller.
  std::shared_ptr<const Loop> sampled;
  /// Of that loop with an element in place of its controller: the loop with the continuous controller and without that
  /// dead time, from which sizes and time scales are taken.
  std::shared_ptr<const Loop> continuous;
  /// The states that state_names name = own_states (origin + X) (see rubbing_coordinates()); empty: origin + X.
  Eigen::MatrixXd own_states;
  /// Plants known by measured data, which the frequency domain reads. In time, and at s off the imaginary axis, their
  /// fits stand for them: a loop for the time domain has none of these.
  std::vector<MeasuredPart> measured;

  Eigen::Index states() const { return A.rows(); }

  /// Closed-loop matrix H(jw) from element outputs w to element inputs x, n_e x n_e, exact with delay. The condition
  /// for a harmonic balance with one element is 1 - N H = 0; the loop's G of the literature is -H. Of a loop with a
  /// sampled controller that of its pulse transfer function and hold (see sampled_response()). Cost O(n^3).
  Eigen::MatrixXcd element_response(double w) const { return element_response(std::complex<double>(0.0, w)); }
  /// The same at any s off the poles.
  Eigen::MatrixXcd element_response(std::complex<double> s) const;

  /// The same loop, measured from its rest point; unchanged if rest_point() is not exact.
  void measure_from_rest();

  /// s I - A and B at s, with delay and measured data: X = (s I - A)^-1 B w.
  struct Resolved {
    Eigen::MatrixXcd from, B;
  };
  Resolved resolved(std::complex<double> s) const;

  /// Response of y to the outputs of the elements, 1 x n_e.
  Eigen::RowVectorXcd output_response(double w) const;

  /// Rest point of the linear part without elements except those with a restoring output (gravity): A X + E ext + B w =
  /// 0 in the least-squares sense; `exact` is true if it solves the equation. Of several points the one near hanging,
  /// or the one with the smallest inputs of the elements; for a torque that gravity cannot hold, that of the tangent.
  Eigen::VectorXd rest_point(bool& exact) const;
  /// The same for the means of an oscillation, A X + E ext + B w = 0: with the given mean outputs of the elements,
  /// except restoring ones, whose mean outputs are found for a sinusoid of amplitude swings(i) on their input.
  Eigen::VectorXd mean_point(const Eigen::VectorXd& mean_outputs, const Eigen::VectorXd& swings, bool& exact) const;

  /// A (without delay), the restoring elements replaced by their tangents at the rest point; A itself without them.
  Eigen::MatrixXd tangent() const;
};

/// First rule that the combination of parts breaks (relative degree, algebraic loop, ...), or nothing.
/// The key is a path such as "loop.plant".
std::optional<BrokenRule> validate(const LoopParts& parts);

/// Joins the parts. Throws std::invalid_argument with the rule if validate() finds one.
Loop build_loop(const LoopParts& parts);

}  // namespace limcycle
