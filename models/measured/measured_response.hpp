#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "limcycle/models/measured/fit_choice.hpp"

namespace limcycle {

/// A measured frequency response with the stable fit that stands for it in time. Immutable; plants share it.
class MeasuredResponse {
 public:
  /// `delay`: dead time that the data hold beside the fit, s: the fit is of data exp(jw delay). Throws
  /// std::invalid_argument with a sentence if no fit of that shape is closer than `worst_rms`.
  MeasuredResponse(std::shared_ptr<const FrequencyData> data, FitWish wish, double delay);

  static constexpr double worst_rms = 0.3;  ///< rms of |fit/data - 1|, beyond which a fit says nothing

  const FrequencyData& data() const { return *data_; }
  const VectorFit& fit() const { return fit_; }
  const FitWish& wish() const { return wish_; }
  double delay() const { return delay_; }

  /// Response of the data over that of fit and delay at w, by which the frequency domain returns to the data: at a
  /// measured frequency exact, between two with logarithms of size and frequency, and the angle, in proportion. 1
  /// beyond the data and in their gaps, where the fit is all there is. Cost O(log n).
  std::complex<double> ratio(double w) const;

  /// Standard deviation of the data, relative, between neighbours the larger; 0 if it is not known or there are no
  /// data.
  double deviation(double w) const;

  /// Frequencies that the data cover, without their gaps, rad/s.
  std::vector<std::pair<double, double>> ranges() const;

  /// "200 points from 0.1 to 1000 rad/s in servo.csv".
  std::string data_in_words() const;
  /// "a fit of order 4 with one pole at zero, which differs from the data by 0.2 % (rms), at most 1 % (at 31 rad/s)".
  std::string fit_in_words() const;

 private:
  std::size_t interval(double w) const;

  std::shared_ptr<const FrequencyData> data_;
  FitWish wish_;
  double delay_ = 0.0;
  VectorFit fit_;
  std::vector<std::complex<double>> log_ratio_;  ///< at the points
  std::vector<std::size_t> gaps_;
};

}  // namespace limcycle
