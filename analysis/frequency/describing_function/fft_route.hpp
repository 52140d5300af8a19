#pragma once
#include <algorithm>
#include <numbers>

#include "limcycle/analysis/frequency/describing_function/harmonics_by_fft.hpp"
#include "limcycle/analysis/frequency/describing_function/quadrature_route.hpp"
#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// Uniform samples of the output over one period that begins at PrescribedMotion::origin().
///
/// A jump between two samples would cost the discrete transform an error of order 1/N. It is taken instead as its mean
/// over one step around each sample, which leaves an error of order 1/N^2; for a jump at a sample this is the mean of
/// both sides.
class UniformSamples {
 public:
  static constexpr bool wants_nodes = false, wants_samples = true;

  explicit UniformSamples(int count) : count_(static_cast<std::size_t>(count)), values_(count_ + 1) {}

  void restart() {
    std::fill(values_.begin(), values_.end(), 0.0);
    taken_ = 0;
  }
  void sample(double output) {
    if (taken_ < count_) values_[++taken_] += output;
  }
  void jump(double position, double height) {
    const double step = 2.0 * std::numbers::pi / static_cast<double>(count_);
    const double at = position / step;
    const auto nearest = static_cast<std::size_t>(std::clamp(std::round(at), 0.0, static_cast<double>(count_)));
    const double smoothed = std::clamp(static_cast<double>(nearest) - at + 0.5, 0.0, 1.0);
    // A sample already taken holds the side before the jump, one to come the side after it.
    values_[nearest] += height * (smoothed - (nearest <= taken_ ? 0.0 : 1.0));
  }

  /// Samples 0..N-1 once a whole period, or half of a half-wave symmetric one, was visited.
  std::vector<double> period(bool half) const {
    std::vector<double> samples(values_.begin(), values_.end() - 1);
    if (!half) {
      samples[0] += values_[count_];
      return samples;
    }
    const std::size_t middle = count_ / 2;
    samples[0] -= values_[middle];
    for (std::size_t j = 0; j < middle; ++j) samples[j + middle] = -samples[j];
    return samples;
  }

 private:
  std::size_t count_, taken_ = 0;
  std::vector<double> values_;
};

/// One element at one point by FFT of uniform samples. The state is marched with equal steps of its own (three-stage
/// Radau IIA, split at reversals and switches), so that this route and the graded quadrature check each other.
class FftRoute {
 public:
  static constexpr int fewest_samples = 256, most_samples = 1 << 20, stages = 3;

  FftRoute(Element element, const PrescribedMotion& motion, bool try_symmetric, double bias, const DfOptions& options)
      : element_(std::move(element)), motion_(motion), try_symmetric_(try_symmetric), bias_(bias), options_(options) {}

  /// Doubles the samples until two resolutions agree and both agree with `other`, the result of the quadrature route,
  /// which reveals a layer that two uniform resolutions both step over.
  DescribingFunction refine(const DescribingFunction& other) {
    DescribingFunction best;
    double last_difference = 0.0;
    int samples = fewest_samples;
    while (samples < 8 * options_.harmonics) samples *= 2;
    for (int k = 0; samples <= most_samples; samples *= 2, ++k) {
      DescribingFunction now = on_samples(samples);
      now.evaluations += best.evaluations;
      if (now.status != Status::converged) return now;
      if (other.gain == 0.0 && std::abs(now.harmonics[0]) <= QuadratureRoute::indistinct * size_)
        now.gain = now.harmonics[0] = 0.0;
      now.error = 1.0;
      if (k > 0) {
        const double difference = std::abs(now.gain - best.gain), size = std::abs(now.gain);
        // Algebraic convergence; the order is estimated from three resolutions and limited to 1/2..4.
        const double order =
            k > 1 && difference > 0.0 ? std::clamp(std::log2(last_difference / difference), 0.5, 4.0) : 0.5;
        const double extrapolated = difference / (std::exp2(order) - 1.0);
        const double apart = std::abs(now.gain - other.gain) + other.error * std::abs(other.gain);
        const double absolute = std::max(extrapolated, apart);
        now.error = absolute == 0.0 ? 0.0 : size == 0.0 ? 1.0 : absolute / size;
        last_difference = difference;
      }
      best = now;
      if (k > 0 && best.error <= options_.accuracy) return best;
    }
    best.status = Status::incomplete;
    return best;
  }

  /// The result with `samples` (a multiple of 4) per period, without an error estimate.
  DescribingFunction on_samples(int samples) {
    const PeriodMesh mesh = uniform_mesh(motion_, samples);
    ElementMarch march(element_, motion_, stages);
    PeriodicStateSearch search(march, mesh, try_symmetric_, 0.0);
    UniformSamples uniform(samples);
    PeriodicState periodic = search.find(uniform, has_guess_ ? &guess_ : nullptr);
    DescribingFunction result;
    result.method = "fft";
    result.status = periodic.status;
    result.evaluations = march.evaluations();
    if (periodic.status != Status::converged) return result;
    result.symmetric = periodic.symmetric;
    const std::vector<double> values = uniform.period(periodic.symmetric);
    auto harmonics = harmonics_by_fft(values, motion_.origin(), options_.harmonics);
    double size = 0.0;
    for (const double value : values) size += std::abs(value);
    size_ = size / samples;
    if (std::abs(harmonics[1]) <= 64.0 * 2.3e-16 * size_) harmonics[1] = 0.0;
    for (std::size_t k = 0; k < harmonics.size(); k += 2)
      if (periodic.symmetric) harmonics[k] = 0.0;
    const double A = motion_.amplitude();
    result.mean = harmonics[0].imag();
    result.harmonics.assign(harmonics.begin() + 1, harmonics.end());
    result.gain = harmonics[1] / A;
    // Work = integral of F (bias + A w cos theta) dt, and of F A cos theta dtheta without drift.
    result.dissipation =
        std::numbers::pi * A * harmonics[1].imag() + bias_ * result.mean * 2.0 * std::numbers::pi / motion_.frequency();
    guess_ = std::move(periodic);
    has_guess_ = true;
    return result;
  }

 private:
  Element element_;
  const PrescribedMotion& motion_;
  bool try_symmetric_;
  double bias_;  ///< mean rate
  DfOptions options_;
  double size_ = 0.0;  ///< mean |output| of the last resolution
  PeriodicState guess_;
  bool has_guess_ = false;
};

}  // namespace limcycle
