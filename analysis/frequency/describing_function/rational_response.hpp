#pragma once
#include <complex>
#include <optional>
#include <vector>

#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Closed interval.
struct Interval {
  double low = 0.0, high = 0.0;
};

/// G(jw) = n(jw)/d(jw) around the only element of a loop, G being minus the closed-loop response from its output to its
/// input, so that the loop is x = -G element(x). The polynomials give what point values cannot: bounds over whole
/// intervals of frequency, by Taylor's formula (exact for a polynomial; roundings are not enclosed), and over all
/// frequencies above one.
class RationalResponse {
 public:
  /// Empty if the loop has not exactly one element, has a delay or a direct path (G not rational or not strictly
  /// proper), if G vanishes, or if the polynomials fail to give G to 1e-9 (the loop's time scales are too far apart).
  /// Faddeev-LeVerrier (1840), cost O(n^4).
  static std::optional<RationalResponse> of(const Loop& loop);

  /// 1/G(jw), w > 0 in rad/s; not finite at a zero of G.
  std::complex<double> inverse(double w) const;

  /// A disc that holds 1/G(jw) for every w of an interval; infinite radius where a zero of G cannot be excluded.
  struct Disc {
    std::complex<double> centre;
    double radius = 0.0;
  };
  Disc inverse(Interval w) const;

  /// Lower bound of |c + 1/G(jw)| for all w of an interval.
  double distance(double c, Interval w) const;
  /// Lower bound of |1/G(jv)| for all v >= w; it grows with w without limit since G is strictly proper. 0: none known.
  double growth(double w) const;
  /// True if |c + 1/G(jw)| > gamma for all w of an interval. Uses the polynomial |d + c n|^2 - gamma^2 |n|^2 in w^2,
  /// which also decides cases where both sides nearly agree (integrators at low frequency). False: not shown.
  bool farther_than(double gamma, double c, Interval w) const;

  /// A frequency in the middle of the loop's time scales, rad/s.
  double scale() const { return scale_; }

 private:
  using Coefficients = std::vector<double>;  // lowest power first, in jw/scale
  Coefficients numerator_, denominator_;
  double scale_ = 1.0;
};

}  // namespace limcycle
