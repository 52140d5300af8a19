#pragma once
#include <Eigen/Core>
#include <complex>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "limcycle/analysis/cycle.hpp"
#include "limcycle/analysis/motion/field/parameter_rates.hpp"
#include "limcycle/analysis/status.hpp"

namespace limcycle {

/// Derivatives of a cycle by one parameter p, per unit of p, with estimates of their absolute errors.
struct CycleDerivative {
  double period = 0.0, period_error = 0.0;                  ///< s
  double amplitude = 0.0, amplitude_error = 0.0;            ///< of half the peak-to-peak of y
  double first_harmonic = 0.0, first_harmonic_error = 0.0;  ///< of the amplitude of y's first harmonic
  double offset = 0.0, offset_error = 0.0;                  ///< of y's mean
  /// In the order of Cycle::multipliers. Empty if the multiplier is not simple or is zero to rounding, so that it has
  /// no derivative, or none that double precision can resolve.
  std::vector<std::optional<std::complex<double>>> multipliers;
  double multiplier_error = 0.0;  ///< the largest of those given
};

/// Derivatives of a cycle by every parameter.
struct CycleDerivatives {
  Status status = Status::converged;
  std::string why;                  ///< one sentence, if there is no result
  std::vector<CycleDerivative> by;  ///< in the order of the neighbours
};

/// Options of the derivatives of a cycle.
struct CycleDerivativeOptions {
  double rtol = 1e-10;  ///< of the integration; a second one, thirty times as loose, gives the errors
  bool multipliers = true;
  long max_steps = 200000;
  std::function<bool()> stop;
};

/// Derivatives of period, amplitude, first harmonic, offset and Floquet multipliers of a cycle with respect to
/// parameters, each given by a pair of neighbours of the loop.
///
/// With P the state after the period T from x0, the cycle is P(x0, T, p) = x0, so that by the implicit function theorem
///   (I - dP/dx0) dx0/dp - f dT/dp = dP/dp,   f . dx0/dp = 0 (fixes the phase).
/// dP/dx0 and dP/dp are those of the variational equations through every stick, slip and switch (cut_cycle). The
/// amplitude follows from the deviations where y turns, or switches at a corner, harmonic and offset from those along
/// the whole cycle (output_derivatives). A multiplier m, simple, with eigenvectors w and v of the product of the step
/// derivatives F_k, moves by  sum_k w' F_K..F_k+1 (dF_k/dp) F_k-1..F_1 v/(w' v);  dF_k/dp is the difference between the
/// derivatives over the same step in the neighbours, beginning and ending on their cycles, which follow from the
/// solution above: no other cycle is computed, and no motion is differenced.
///
/// A half-wave symmetric cycle whose neighbours are symmetric too is integrated over half a period: its end, reflected,
/// is its start; a multiplier is the square of one of the half period.
///
/// The cycle must have the accuracy of shooting (residual 1e-9 or less) and begin off its switches. If a switch is
/// grazed there is no derivative: Status stalled. Nor is there one for a cycle that keeps part of its history
/// (Cycle::remembered): Status undefined. Cost: a march of the period with a linear system of 3n and n + q columns a
/// step, and for multipliers 2 q more such systems: for a servo with bristles and ten parameters as much as finding the
/// cycle without multipliers, five times as much with them.
CycleDerivatives cycle_derivatives(const Loop& loop, const Cycle& cycle,
                                   std::span<const ParameterNeighbours> neighbours,
                                   const CycleDerivativeOptions& options = {});

}  // namespace limcycle
