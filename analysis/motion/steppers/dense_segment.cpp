#include "limcycle/analysis/motion/steppers/dense_segment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace limcycle {

double DenseSegment::fraction(double t) const {
  const double length = end_ - start_;
  // Sampling on a grid meets the ends within a few roundings of t; more than that is extrapolation.
  const double slack = 1e-12 * std::abs(length) +
                       4 * std::numeric_limits<double>::epsilon() * std::max({1.0, std::abs(start_), std::abs(end_)});
  const double low = std::min(start_, end_) - slack;
  const double high = std::max(start_, end_) + slack;
  if (!(t >= low && t <= high))
    throw std::invalid_argument("time " + std::to_string(t) + " is outside the step from " + std::to_string(start_) +
                                " to " + std::to_string(end_));
  return length == 0 ? 0 : std::clamp((t - start_) / length, 0.0, 1.0);
}

void DenseSegment::at(double t, State& x) const {
  const double theta = fraction(t);
  x.resize(first_.size());
  for (std::size_t i = 0; i < first_.size(); ++i) x[i] = value(theta, i);
}

double DenseSegment::at(double t, std::size_t component) const {
  if (component >= first_.size())
    throw std::invalid_argument("component " + std::to_string(component) + " of a state of " +
                                std::to_string(first_.size()));
  return value(fraction(t), component);
}

}  // namespace limcycle
