#pragma once
#include <cmath>
#include <complex>
#include <vector>

#include "limcycle/analysis/frequency/march/prescribed_motion.hpp"

namespace limcycle {

/// Integrals of an element's output over a period, summed over the nodes of the march itself.
class HarmonicSums {
 public:
  static constexpr bool wants_nodes = true, wants_samples = false;

  explicit HarmonicSums(int orders) : sine_(static_cast<std::size_t>(orders)), cosine_(sine_.size()) {}

  void restart() {
    sine_.assign(sine_.size(), 0.0);
    cosine_.assign(cosine_.size(), 0.0);
    output_ = work_ = size_ = 0.0;
  }

  void node(const MotionNode& node, double weight, double output) {
    const double part = weight * output;
    output_ += part;
    size_ += std::abs(part);
    work_ += part * node.in.v;
    double s = node.sine, c = node.cosine;
    for (std::size_t k = 0; k < sine_.size(); ++k) {
      sine_[k] += part * s;
      cosine_[k] += part * c;
      const double next = s * node.cosine + c * node.sine;
      c = c * node.cosine - s * node.sine;
      s = next;
    }
  }

  /// Sine + j cosine coefficient of order k, from a whole period or from half of a half-wave symmetric one.
  std::complex<double> harmonic(int k, bool half) const {
    if (half) return k % 2 == 0 ? 0.0 : 2.0 * coefficient(k);
    return coefficient(k);
  }
  double mean(bool half) const { return half ? 0.0 : output_ / (2.0 * pi); }
  /// Integral of output times rate over the time of one period.
  double work(bool half, double frequency) const { return (half ? 2.0 : 1.0) * work_ / frequency; }
  /// Mean of |output|, the size against which sums may cancel.
  double size(bool half) const { return size_ / (half ? pi : 2.0 * pi); }

 private:
  static constexpr double pi = 3.14159265358979323846;

  std::complex<double> coefficient(int k) const {
    const auto i = static_cast<std::size_t>(k - 1);
    return {sine_[i] / pi, cosine_[i] / pi};
  }

  std::vector<double> sine_, cosine_;
  double output_ = 0.0, work_ = 0.0, size_ = 0.0;
};

}  // namespace limcycle
