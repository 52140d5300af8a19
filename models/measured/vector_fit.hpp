#pragma once
#include <optional>

#include "limcycle/models/measured/frequency_data.hpp"
#include "limcycle/models/measured/pole_basis.hpp"

namespace limcycle {

/// What a fit has to be.
struct FitShape {
  int order = 1;            ///< number of poles, those at zero included
  int poles_at_zero = 0;    ///< 0..2
  int relative_degree = 1;  ///< 1 or 2: how fast it falls at high frequency, at least
};

/// The distance of a fit from its data: |fit/data - 1|.
struct FitError {
  double rms = 0.0, largest = 0.0;
  double at = 0.0;                   ///< rad/s, of the largest
  std::optional<double> deviations;  ///< rms of the distance over the standard deviation of the data, if that is known
};

/// A stable rational function through the data: all poles in the left half plane but for those at zero.
struct VectorFit {
  FitShape shape;
  StateSpace model;  ///< strictly proper; with relative degree 2 C B is zero to rounding
  FitError error;
  double misfit = 0.0;  ///< mean square of the weighted distance that the fit makes small
  int iterations = 0;
};

/// The fit at s = jw.
std::complex<double> response_of(const StateSpace& model, double w);

/// Vector fitting: from starting poles spread over the band, sigma(s) G(s) = numerator(s), both over the same poles, is
/// solved by linear least squares; the zeros of sigma are the next poles (those in the right half plane are mirrored).
/// With the relaxed normalisation of sigma and the orthonormal basis of PoleBasis; poles at zero are in the numerator
/// only. The distance is relative, divided by the standard deviation of the data if that is known. Then the numerator
/// alone is fitted over the best poles met. With relative degree 2 the numerator is restricted to that throughout.
///
/// B. Gustavsen and A. Semlyen, "Rational approximation of frequency domain responses by vector fitting", IEEE Trans.
/// Power Delivery 14 (1999) 1052; B. Gustavsen, "Improving the pole relocating properties of vector fitting", 21 (2006)
/// 1587; D. Deschrijver, B. Haegeman and T. Dhaene, "Orthonormal vector fitting", IEEE Trans. Adv. Packaging 30 (2007)
/// 216.
///
/// Needs order > poles_at_zero or order = poles_at_zero, order >= relative_degree, and 2 points more than half the
/// unknowns. Cost: some ten least-squares problems of 2 points rows and 2 order + 1 columns.
VectorFit vector_fit(const FrequencyData& data, const FitShape& shape);

/// Least number of points for a fit of that order: half as many numbers are left over as are fitted, and two.
int least_points(int order);

}  // namespace limcycle
