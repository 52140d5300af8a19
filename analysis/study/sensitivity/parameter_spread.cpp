#include "limcycle/analysis/study/sensitivity/parameter_spread.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>

namespace limcycle {

std::string_view to_string(Distribution distribution) {
  switch (distribution) {
    case Distribution::uniform:
      return "uniform";
    case Distribution::log_uniform:
      return "log-uniform";
    default:
      return "normal";
  }
}

double SpreadParameter::quantile(double p) const {
  if (!(p >= 0.0 && p <= 1.0))
    throw std::invalid_argument("a quantile needs a share in 0..1, got " + std::to_string(p));
  if (distribution != Distribution::normal) {
    if (p == 0.0 || p == 1.0) return p == 0.0 ? low : high;
    return distribution == Distribution::uniform ? std::lerp(low, high, p)
                                                 : low * std::exp(p * std::log(high / low));  // of one sign
  }
  const double a = (low - mean) / deviation, b = (high - mean) / deviation;
  const double below = gsl_cdf_ugaussian_P(a), above = gsl_cdf_ugaussian_Q(b);
  // Computed from the nearer tail, where a small share keeps its digits.
  const double between = a > 0.0 ? gsl_cdf_ugaussian_Q(a) - above : gsl_cdf_ugaussian_P(b) - below;
  const double from_low = below + p * between, from_high = above + (1.0 - p) * between;
  const double z = from_low < 0.5 ? gsl_cdf_ugaussian_Pinv(from_low) : gsl_cdf_ugaussian_Qinv(from_high);
  return std::fmin(std::fmax(mean + deviation * z, low), high);
}

namespace {
constexpr double two_deviations = 0.02275013194817921;  // share of a normal distribution below -2
}

double SpreadParameter::low_end() const {
  return quantile(distribution == Distribution::normal ? two_deviations : 0.0);
}
double SpreadParameter::high_end() const {
  return quantile(distribution == Distribution::normal ? 1.0 - two_deviations : 1.0);
}

JointSpread::JointSpread(const ParameterSpread& spread) : parameters_(spread.parameters) {
  if (spread.correlations.empty()) return;
  const auto n = static_cast<Eigen::Index>(parameters_.size());
  factor_ = Eigen::MatrixXd::Identity(n, n);
  for (const auto& [one, other, value] : spread.correlations)
    factor_(static_cast<Eigen::Index>(std::max(one, other)), static_cast<Eigen::Index>(std::min(one, other))) = value;
  constexpr double least_pivot = 1e-10;   // of a matrix with ones on its diagonal
  for (Eigen::Index i = 0; i < n; ++i) {  // Cholesky's factor, row by row in the place of the lower half
    for (Eigen::Index k = 0; k < i; ++k)
      factor_(i, k) = (factor_(i, k) - factor_.row(i).head(k).dot(factor_.row(k).head(k))) / factor_(k, k);
    const double pivot = 1.0 - factor_.row(i).head(i).squaredNorm();
    if (!(pivot > least_pivot))
      throw std::invalid_argument("no distribution has these correlations: " +
                                  parameters_[static_cast<std::size_t>(i)].path + " cannot have all of its own");
    factor_(i, i) = std::sqrt(pivot);
  }
}

std::vector<double> JointSpread::values(std::vector<double> shares) const {
  if (correlated()) {
    Eigen::VectorXd scores(std::ssize(shares));
    for (std::size_t i = 0; i < shares.size(); ++i)
      scores(static_cast<Eigen::Index>(i)) = gsl_cdf_ugaussian_Pinv(shares[i]);
    const Eigen::VectorXd joint = factor_ * scores;
    for (std::size_t i = 0; i < shares.size(); ++i)
      shares[i] = gsl_cdf_ugaussian_P(joint(static_cast<Eigen::Index>(i)));
  }
  for (std::size_t i = 0; i < shares.size(); ++i) shares[i] = parameters_[i].quantile(shares[i]);
  return shares;
}

std::vector<std::vector<double>> corner_points(const ParameterSpread& spread) {
  const auto& parameters = spread.parameters;
  std::vector<std::vector<double>> points(1);
  if (parameters.empty()) return {};
  for (const auto& one : parameters) points[0].push_back(one.quantile(0.5));
  const std::size_t corners = parameters.size() == 1 ? 2 : parameters.size() <= 3 ? 4 : 8;
  for (unsigned row = 0; row < corners; ++row) {
    auto& point = points.emplace_back();
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const auto column = static_cast<unsigned>(1 + i % (corners - 1));
      const bool odd = std::popcount(row & column) % 2 == 1, turned = i / (corners - 1) % 2 == 1;
      point.push_back(odd == turned ? parameters[i].low_end() : parameters[i].high_end());
    }
  }
  return points;
}

}  // namespace limcycle
