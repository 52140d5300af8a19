#pragma once
#include <optional>
#include <vector>

#include "limcycle/analysis/study/global/estimate.hpp"
#include "limcycle/analysis/study/global/sobol_design.hpp"

namespace limcycle {

/// Answers in the rows of the first samples of a design, less their mean in rows A and B and in units of the largest
/// one, so that none of their squares overflows or loses the digits in which answers differ: neither changes a share of
/// the variance. Infinite ones and NaN have become none.
class ScaledAnswers {
 public:
  ScaledAnswers(const SobolDesign& design, RowAnswers answers, std::size_t samples);

  const std::optional<double>& operator[](std::size_t row) const { return rows_[row]; }
  std::size_t rows() const { return rows_.size(); }
  std::size_t missing() const { return missing_; }

  std::size_t base() const { return base_; }               ///< how many rows A and B answered
  double mean() const { return mean_ * size_; }            ///< in rows A and B, as it was
  double deviation() const { return deviation_ * size_; }  ///< standard deviation there, as it was

  /// Standard deviation, scaled, below which the answers do not differ but by rounding or noise.
  double least(double noise) const;
  bool constant(double noise) const { return deviation_ <= least(noise); }

 private:
  std::vector<std::optional<double>> rows_;
  std::size_t missing_ = 0, base_ = 0;
  double size_ = 0.0, mean_ = 0.0, deviation_ = 0.0;
};

}  // namespace limcycle
