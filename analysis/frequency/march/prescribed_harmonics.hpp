#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

#include "limcycle/analysis/frequency/march/prescribed_motion.hpp"

namespace limcycle {

/// A real series of a phase theta by its harmonics: sum over n of Im(c_n exp(j n theta)), so that c_n = b + j a stands
/// for b sin(n theta) + a cos(n theta), and c_0 = j mean.
double series_value(const Eigen::VectorXcd& coefficients, double phase);

/// The motion x = x_0 + sum_n Im(X_n exp(j n theta)) + V t of several harmonics, theta = w t, V the mean rate, as a
/// function of the phase measured from anchors. As in PrescribedMotion (its case of one harmonic) the rate is formed
/// from the distance to the nearest reversal: 1 - cos(n d) and sin(n d) come from recurrences without cancellation, so
/// that it is exact to about n roundings however small it is.
///
/// Anchors: 0 phase 0, where history begins; 1 to stops() the reversals and other phases of least speed in one period,
/// the first of them (a reversal if there is one) being where the period begins; stops() + 1 its end. For a half-wave
/// symmetric motion (odd harmonics only) anchor 1 + stops()/2 is half a period after anchor 1.
class PrescribedHarmonics {
 public:
  /// `input`: X_n at index n. `half_wave`: only odd harmonics are used, and neither mean. Throws std::invalid_argument
  /// quoting a frequency that is not positive, a coefficient that is not finite, or that the input does not oscillate.
  /// Cost of the construction: about 8 H^2 for the reversals.
  PrescribedHarmonics(const Eigen::VectorXcd& input, double frequency, double mean_rate, bool half_wave);

  MotionNode at(int anchor, double local) const;

  double frequency() const { return frequency_; }
  double mean_rate() const { return drift_; }
  bool half_wave() const { return half_wave_; }
  int stops() const { return static_cast<int>(anchors_.size()) - 2; }
  double phase(int anchor) const { return of(anchor).phase; }
  double rate(int anchor) const { return of(anchor).rate; }  ///< exactly 0 at a reversal
  double least_speed() const;                                ///< 0 if the motion reverses
  double origin() const { return anchors_[1].phase; }
  double position(int anchor, double local) const { return of(anchor).phase + local - origin(); }
  /// Phase over which the motion leaves the neighbourhood of the anchor in which an element with these scales changes.
  double layer(int anchor, const Scales& scales) const;

 private:
  struct Anchor {
    double phase = 0.0, sine = 0.0, cosine = 1.0, rate = 0.0, level = 0.0;
    std::vector<double> re, im;  ///< of X_n exp(j n phase)
  };
  struct Rates {
    double v, slope;  ///< rate and its derivative by the phase, over the frequency
  };

  const Anchor& of(int anchor) const { return anchors_[static_cast<std::size_t>(anchor)]; }
  Rates rates(double phase) const;
  double root(double low, double high, bool of_slope) const;
  void find_stops(double from, double to, std::vector<double>& reversals, std::vector<double>& slowest) const;
  Anchor anchor(double phase, bool reversal) const;
  void place_anchors();

  double frequency_, drift_, mean_ = 0.0;
  bool half_wave_;
  int first_ = 1, stride_ = 1;  ///< orders first, first + stride, ...
  std::vector<std::complex<double>> input_;
  std::vector<double> order_;
  double bend_ = 0.0;  ///< bound of |v''| by the phase
  std::vector<Anchor> anchors_;
};

/// The graded mesh of a period, as for one harmonic: split and graded at every reversal, and where the motion nearly
/// stops on the element's scale of velocity. `first` is the first half of a half-wave symmetric motion, else the whole
/// period.
PeriodMesh graded_mesh(const PrescribedHarmonics& motion, const Scales& scales, const MeshSettings& settings);

}  // namespace limcycle
