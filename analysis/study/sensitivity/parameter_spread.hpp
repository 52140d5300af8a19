#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace limcycle {

enum class Distribution { uniform, log_uniform, normal };
std::string_view to_string(Distribution distribution);

/// Distribution of one number of a case.
struct SpreadParameter {
  std::string path;    ///< "loop.friction.Fs"
  double value = 0.0;  ///< in the case
  Distribution distribution = Distribution::uniform;
  double low = 0.0, high = 0.0;        ///< bounds; a normal distribution is cut off there, and may have infinite ones
  double mean = 0.0, deviation = 0.0;  ///< of a normal distribution before it is cut off

  /// Value below which a share p (0..1) of the distribution lies: maps a uniform sample to a sample of this
  /// distribution. Infinite at the ends of a normal distribution without bounds. Throws std::invalid_argument for p
  /// outside.
  double quantile(double p) const;
  /// The ends to use if few points must suffice: the bounds; for a normal distribution its quantiles at two deviations
  /// from the middle (2.3 % and 97.7 %).
  double low_end() const;
  double high_end() const;
};

/// [sensitivity] of a case: the distributions of its parameters, and the number of samples of a study.
struct ParameterSpread {
  std::vector<SpreadParameter> parameters;
  int samples = 256;
  std::uint64_t seed = 0;
};

/// A few points of the spread, always the same ones: its middle (all medians), then corners, in which every parameter
/// is at one of its ends. Up to two parameters: all corners; three: four of the eight; more: eight corners of a
/// Hadamard design, in which each of up to seven parameters is four times low and four times high, independently of any
/// other one. Beyond seven, parameter i + 7 is low where parameter i is high. One row per point, in the order of the
/// parameters.
std::vector<std::vector<double>> corner_points(const ParameterSpread& spread);

}  // namespace limcycle
