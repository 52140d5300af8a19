#include "limcycle/analysis/motion/steppers/step_size.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limcycle {

namespace {

constexpr double safety = 0.9;
constexpr double most_growth = 6;
constexpr double most_shrinking = 0.2;
constexpr double exponent = 1.0 / 5;  // error = phi h^5
/// A smaller error reflects rounding rather than the trend.
constexpr double least_error = 0.01;

}  // namespace

double StepSizeControl::after_success(double h, double error) {
  double factor = safety * std::pow(error, -exponent);  // error 0: infinity, limited below
  if (old_h_ != 0) {
    const double bounded = std::max(error, least_error);
    const double predicted = safety * std::abs(h / old_h_) * std::pow(old_error_ / (bounded * bounded), exponent);
    factor = std::min(factor, predicted);
  }
  factor = std::clamp(factor, most_shrinking, rejected_ ? 1.0 : most_growth);
  old_h_ = h;
  old_error_ = std::max(error, least_error);
  rejected_ = false;
  return h * factor;
}

double StepSizeControl::after_failure(double h, double error) {
  rejected_ = true;
  // An infinite error gives the shortest step. The upper limit prevents a retry of the step that just failed.
  const double shorter = h * std::clamp(safety * std::pow(error, -exponent), most_shrinking, safety);
  // The step stays positive after any number of failures: the caller stops when the time no longer advances.
  return std::copysign(std::max(std::abs(shorter), std::numeric_limits<double>::min()), h);
}

}  // namespace limcycle
