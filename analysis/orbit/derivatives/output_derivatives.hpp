#pragma once
#include <Eigen/Core>

#include "limcycle/analysis/orbit/cycle/cycle_pieces.hpp"

namespace limcycle {

/// d(mean of y)/dp and d(amplitude of y's first harmonic)/dp, one entry per parameter.
struct OutputDerivatives {
  double mean = 0.0, first_harmonic = 0.0;  ///< the quantities themselves
  Eigen::RowVectorXd by_mean, by_first_harmonic;
};

/// From the deviations along a cycle cut with its output read (CutOptions::read_output): with I = int_0^T y e^{-jwt}
/// dt, w = 2 pi/T, and y' the deviation of y at the time t,
///   dI/dp = int y' e^{-jwt} dt + y(T) dT/dp - j dw/dp int t y e^{-jwt} dt,   first harmonic |2 I/T|,
/// and a switch that makes y jump adds the jump times the shift of its moment. The integrals are those of the method
/// that integrates the deviations (Radau IIA of order 5), or of Boole's rule where the flow is exact. `solution`:
/// dx0/dp, with the derivative of the integrated time in the last row: with a mirror half a period, over which y is
/// taken from its middle. Without a first harmonic its derivative is 0.
OutputDerivatives output_derivatives(const Loop& loop, const CyclePieces& cut, const ParameterRates& rates,
                                     const Eigen::MatrixXd& solution);

}  // namespace limcycle
