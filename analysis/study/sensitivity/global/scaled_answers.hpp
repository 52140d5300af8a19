#pragma once
#include <optional>
#include <vector>

#include "limcycle/analysis/study/sensitivity/global/estimate.hpp"
#include "limcycle/analysis/study/sensitivity/global/sobol_design.hpp"

namespace limcycle {

/// Answers in the rows of the first samples of a design, less their mean in rows A and B and in units of the largest
/// one, so that none of their squares overflows or loses the digits in which answers differ: shares of the variance
/// stay the same. Infinite ones and NaN are treated as missing.
class ScaledAnswers {
 public:
  ScaledAnswers(const SobolDesign& design, RowAnswers answers, std::size_t samples);

  const std::optional<double>& operator[](std::size_t row) const { return rows_[row]; }
  std::size_t rows() const { return rows_.size(); }
  std::size_t missing() const { return missing_; }

  std::size_t base() const { return base_; }               ///< number of answers in rows A and B
  double mean() const { return mean_ * size_; }            ///< in rows A and B, unscaled
  double deviation() const { return deviation_ * size_; }  ///< standard deviation there, unscaled

  /// Standard deviation, scaled, below which answers differ only by rounding or noise.
  double least(double noise) const;
  bool constant(double noise) const { return deviation_ <= least(noise); }

 private:
  std::vector<std::optional<double>> rows_;
  std::size_t missing_ = 0, base_ = 0;
  double size_ = 0.0, mean_ = 0.0, deviation_ = 0.0;
};

}  // namespace limcycle
