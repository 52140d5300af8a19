#pragma once
#include <functional>
#include <optional>

#include "limcycle/analysis/study/identify/fit.hpp"

namespace limcycle {

/// 95 % interval of a number. An end that the records do not give is empty.
struct NumberInterval {
  std::optional<double> low = {}, high = {};  ///< by profile likelihood
  std::optional<double> linear_low = {},
                        linear_high = {};  ///< from the derivatives at the fit alone, in the same coordinate
  bool identifiable = false;               ///< see profile_interval()
  bool complete = true;                    ///< false: a profile did not converge; its end is empty
};

/// Covariance of the coordinates by the derivatives at a fit, for entries of unit variance; infinite variances where
/// the derivatives are dependent to 1e-8.
struct LinearCovariance {
  Eigen::MatrixXd covariance;       ///< of what is determined
  Eigen::VectorXd deviation;        ///< standard deviation of each coordinate; infinite if not determined
  Eigen::VectorXd singular_values;  ///< of the derivatives, falling
  Eigen::MatrixXd directions;       ///< their right singular vectors
};
/// `units`: in which singular values and directions count the coordinates; empty: 1.
LinearCovariance linear_covariance(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& units = {});

/// Largest rise of the sum of squares within a 95 % interval: t^2 s^2, with Student's t for n - k degrees of freedom
/// and the variance s^2 = sum/(n - k) of an entry, which is `least` at least where the fit is exact: with free motions
/// that of the error of the simulation.
double interval_rise(double sum_of_squares, Eigen::Index entries, Eigen::Index coordinates, double least);

/// A fit within the bounds of its space, and what the derivatives there say. Keeps references.
struct FitWithSlopes {
  const Misfit& misfit;
  const Fit& fit;
  LinearCovariance linear;
  double rise;  ///< see interval_rise()
};
/// Nothing if the law has no answer there, or no number is free. Cost: one evaluation with derivatives.
std::optional<FitWithSlopes> with_slopes(const Misfit& misfit, const Fit& fit);

/// Interval of number `index` of the space: where the least sum of squares over all other numbers, within the bounds,
/// rises by `rise`, each end to about 2 % of the half-width; or the bound, if that comes first. The number is
/// identifiable if both ends are within a factor of ten of the value (for one that may be 0: the upper end within ten
/// times its typical size; for a share: a range of 0.6 at most); where a profile did not converge its linear end
/// counts. `better` gets a fit that is better than that of `at` if one turns up. Cost: 4 to 12 short fits.
NumberInterval profile_interval(const FitWithSlopes& at, std::size_t index, std::optional<Fit>& better,
                                const std::function<bool()>& stop);

/// The same by the derivatives at the fit alone, in the coordinate of the number.
NumberInterval linear_interval(const FitWithSlopes& at, std::size_t index);

}  // namespace limcycle
