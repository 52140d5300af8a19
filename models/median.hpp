#pragma once
#include <algorithm>
#include <iterator>
#include <vector>

namespace limcycle {

/// The middle of these values, of an even number the upper one of the two; there must be one. Cost: linear on average.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace limcycle
