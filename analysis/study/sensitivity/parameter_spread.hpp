#pragma once
#include <Eigen/Core>
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

/// Correlation of two parameters, by their numbers in the list: that of the normal scores of their shares.
struct SpreadCorrelation {
  std::size_t one = 0, other = 0;
  double value = 0.0;  ///< -1 < value < 1
};

/// [sensitivity] of a case: the distributions of its parameters, and the number of samples of a study.
struct ParameterSpread {
  std::vector<SpreadParameter> parameters;
  std::vector<SpreadCorrelation> correlations{};  ///< each pair at most once; other pairs are independent
  int samples = 256;
  std::uint64_t seed = 0;
};

/// The joint distribution of the parameters of a spread: a Gaussian copula. Independent shares u become normal scores z
/// = Phi^-1(u), these L z with L L^T the matrix of correlations, and these shares again, of which each distribution
/// takes its quantile: every parameter keeps its own distribution (R. B. Nelsen, An Introduction to Copulas, 2nd ed.
/// 2006, 2.9). For normal distributions that are hardly cut off, the correlations are those of the parameters
/// themselves.
class JointSpread {
 public:
  /// Throws std::invalid_argument if no distribution has these correlations: their matrix is not positive definite.
  explicit JointSpread(const ParameterSpread& spread);

  bool correlated() const { return factor_.size() > 0; }
  /// Values of the parameters at independent shares (0..1), in the order of the spread.
  std::vector<double> values(std::vector<double> shares) const;

 private:
  std::vector<SpreadParameter> parameters_;
  Eigen::MatrixXd factor_;  ///< L; empty: all are independent
};

/// A few points of the spread, always the same ones: its middle (all medians), then corners, in which every parameter
/// is at one of its ends. Up to two parameters: all corners; three: four of the eight; more: eight corners of a
/// Hadamard design, in which each of up to seven parameters is four times low and four times high, independently of any
/// other one. Beyond seven, parameter i + 7 is low where parameter i is high. One row per point, in the order of the
/// parameters. Correlations are disregarded.
std::vector<std::vector<double>> corner_points(const ParameterSpread& spread);

}  // namespace limcycle
