#pragma once
#include <complex>
#include <span>
#include <string>
#include <vector>

#include "limcycle/analysis/motion/field/parameter_rates.hpp"
#include "limcycle/analysis/orbit/derivatives/df_derivatives.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Derivatives of the oscillation that the describing function predicts by one parameter, per unit of it.
struct PredictionDerivative {
  GainDerivative gain;                            ///< of N at the root, at fixed amplitude and frequency
  double amplitude = 0.0, amplitude_error = 0.0;  ///< of y's first harmonic
  double frequency = 0.0, frequency_error = 0.0;  ///< rad/s
};

/// Derivatives of a predicted oscillation by every parameter.
struct PredictionDerivatives {
  Status status = Status::converged;
  std::string why;                            ///< one sentence, if there is no result
  double amplitude = 0.0, frequency = 0.0;    ///< predicted: of y's first harmonic; rad/s
  double input_amplitude = 0.0;               ///< of the element's input
  std::complex<double> gain;                  ///< N there
  double gain_error = 0.0;                    ///< absolute
  GainDerivative by_amplitude, by_frequency;  ///< of N, by those of the element's input
  std::vector<PredictionDerivative> by;       ///< in the order of the neighbours
};

/// Derivatives of the root (A, w) of  1 + N(A, w; p) G(jw; p) = 0,  known to the last digits, by the implicit function
/// theorem:  (N G)_A dA + (N G)_w dw = -(N G)_p dp,  two real equations for each parameter. Those of N are
/// df_derivatives'; G, which is exact, is differenced between the neighbours: a difference of an equation, never of a
/// result. The amplitude of y follows the exact ratio of y to the element's input. The speed of a belt acts as the bias
/// of N.
///
/// Status: undefined if the loop has more than one element or a forward element with a bias, or as for df_derivatives;
/// stalled if (A, w) is no root or a double one.
PredictionDerivatives prediction_derivatives(const Loop& loop, double input_amplitude, double frequency,
                                             std::span<const ParameterNeighbours> neighbours,
                                             const DfDerivativeOptions& options = {});

}  // namespace limcycle
