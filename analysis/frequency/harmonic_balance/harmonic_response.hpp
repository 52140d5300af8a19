#pragma once
#include <Eigen/Core>

#include "limcycle/analysis/frequency/march/periodic_state.hpp"
#include "limcycle/analysis/frequency/march/prescribed_harmonics.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// Output of an element in its periodic steady state.
struct HarmonicResponse {
  Eigen::VectorXcd harmonics;  ///< index n: order n as b + j a (b sin + a cos, sine reference); index 0: j mean
  bool symmetric = false;      ///< the steady state is half-wave symmetric
  double error = 0.0;  ///< estimated largest error of a harmonic, units of the output (harmonic_response() only)
  Status status = Status::converged;
  long evaluations = 0;  ///< of the element's equations
};

/// Options of the response to several harmonics.
struct HarmonicResponseOptions {
  int harmonics = 7;       ///< orders 0..harmonics are returned, 1..1000
  double accuracy = 1e-9;  ///< wanted error of every harmonic, relative to the largest; 1e-13..1e-1
  bool half_wave = false;  ///< the input has odd harmonics only and the steady state that mirrors itself is wanted
  double mean_rate = 0.0;  ///< V of PrescribedHarmonics (rubbing on a belt)
};

/// Harmonics of the periodic output of one element for the input sum_n Im(input_n exp(j n w t)) + mean_rate t, by exact
/// integration between switches and reversals (the quadrature of the collocation on graded panels, as for the
/// describing function), not from samples: nothing is aliased. Refined until two meshes agree; Status incomplete if
/// none did.
///
/// The motion is prescribed: a set-valued law never sticks under it, and a follower of sgn(v) switches at once.
/// Throws std::invalid_argument quoting an option or an input out of range.
HarmonicResponse harmonic_response(const Element& element, const Eigen::VectorXcd& input, double frequency,
                                   const HarmonicResponseOptions& options = {});

/// The same for many inputs that differ little, on a mesh of given fineness: the periodic state of one is the guess for
/// the next. One object serves one thread.
class ElementHarmonics {
 public:
  static constexpr int finest = 6;  ///< of the levels of quadrature_meshes

  explicit ElementHarmonics(Element element) : element_(std::move(element)) {}

  /// Orders 0..orders on mesh `level`, 0..finest, the periodic state to `tolerance` of its scale. Not half-wave
  /// symmetric although the motion is so: status no_cycle.
  HarmonicResponse operator()(const PrescribedHarmonics& motion, int orders, int level, double tolerance);

  /// The same with the derivative of the harmonics, see ResponseDerivative: its orders are those of the motion up to
  /// `orders`, as input and as output, and 0 as output unless the motion is half-wave symmetric.
  HarmonicResponse with_derivative(const PrescribedHarmonics& motion, int orders, int level, double tolerance,
                                   Eigen::MatrixXd& derivative);

 private:
  HarmonicResponse on_mesh(const PrescribedHarmonics& motion, int orders, int level, double tolerance,
                           Eigen::MatrixXd* derivative);

  Element element_;
  PeriodicState guess_;
  bool has_guess_ = false;
};

}  // namespace limcycle
