#pragma once
#include <complex>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "limcycle/analysis/status.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// An element with a slightly smaller parameter, and one with a slightly larger one; see ParameterNeighbours.
struct ElementNeighbours {
  Element low, high;
  double step = 0.0;   ///< half the difference of the parameter between them, in its unit
  double value = 0.0;  ///< of the parameter
};

/// Derivative of a gain N by one number, per unit of it.
struct GainDerivative {
  std::complex<double> gain;
  double error = 0.0;  ///< estimated, absolute
};

/// A describing function and its derivatives.
struct DfDerivatives {
  Status status = Status::converged;
  std::string why;            ///< one sentence, if there is no result
  std::complex<double> gain;  ///< N itself, as in DescribingFunction
  double gain_error = 0.0;    ///< estimated, absolute
  GainDerivative amplitude, frequency, bias;
  std::vector<GainDerivative> by;  ///< in the order of the neighbours
};

/// Options of the derivatives of a describing function.
struct DfDerivativeOptions {
  double rtol = 1e-10;  ///< of the integration; a second one, thirty times as loose, gives the errors
  long max_steps = 200000;
  std::function<bool()> stop;
};

/// Derivatives of the describing function N(A, w) of an element, driven by A sin wt and a bias (a mean velocity for a
/// friction law), with respect to its parameters, amplitude, frequency and bias.
///
/// An oscillator (s, c), independent of the element, drives it; two states in resonance collect the output F,
///   s' = w c,  c' = -w s,  q1' = w q2,  q2' = -w q1 + F,  x = A s,
/// so that after the period T = 2 pi/w  q(T) is exactly the first sine and cosine integral:  N = e^{-j phi} w/(pi A)
/// (-q1 + j q2), phi the phase at the start. With P the state after the period, the element's own state z is periodic,
/// P_z(z, p) = z, so that  dz/dp = (I - dP_z/dz)^-1 dP_z/dp,  dq/dp = dP_q/dp + dP_q/dz dz/dp.  The derivatives of P
/// are those of the variational equations through every switch (cut_cycle): no result is differenced. Odd elements
/// without bias are integrated over half a period, whose fixed point P_z = -z is the half-wave symmetric state: it is
/// unique where the map of the full period keeps the state of an elastic range. N is then even in the bias.
///
/// Status: undefined (a law that needs the applied force or stores return points, a periodic state that is not unique),
/// stalled (a switch is grazed, or the motion could not be followed), interrupted. Throws std::invalid_argument for
/// values that are not finite, an amplitude or a frequency that is not positive, and neighbours that do not fit. Cost:
/// about ten marches of a period, two with a linear system of 3n and n + q columns a step.
DfDerivatives df_derivatives(const Element& element, double amplitude, double frequency, double bias,
                             std::span<const ElementNeighbours> neighbours, const DfDerivativeOptions& options = {});

}  // namespace limcycle
