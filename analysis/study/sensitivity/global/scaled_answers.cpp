#include "limcycle/analysis/study/sensitivity/global/scaled_answers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limcycle {

ScaledAnswers::ScaledAnswers(const SobolDesign& design, RowAnswers answers, std::size_t samples) {
  const auto taken = answers.first(samples * design.rows_per_sample());
  rows_.assign(taken.begin(), taken.end());
  for (auto& y : rows_) {
    if (y && !std::isfinite(*y)) y.reset();
    if (!y) ++missing_;
    if (y) size_ = std::max(size_, std::abs(*y));
  }
  std::vector<double> base;
  for (std::size_t k = 0; k < samples; ++k)
    for (const auto row : {design.row_a(k), design.row_b(k)})
      if (rows_[row]) base.push_back(*rows_[row]);
  base_ = base.size();
  if (size_ == 0.0) return;  // all answers are 0
  const auto count = static_cast<double>(base.size());
  for (double& y : base) mean_ += (y /= size_) / count;
  double squares = 0.0;
  for (const double y : base) squares += (y - mean_) * (y - mean_);
  if (base.size() > 1) deviation_ = std::sqrt(squares / (count - 1.0));
  for (auto& y : rows_)
    if (y) *y = *y / size_ - mean_;
}

double ScaledAnswers::least(double noise) const {
  constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();  // the largest answer is 1
  return size_ > 0.0 ? std::max(rounding, noise / size_) : rounding;
}

}  // namespace limcycle
