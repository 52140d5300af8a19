#include "limcycle/models/measured/frequency_data.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/models/median.hpp"

namespace limcycle {

std::vector<std::size_t> gaps_in(const std::vector<double>& frequency) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i + 1 < frequency.size(); ++i) ratios.push_back(std::log(frequency[i + 1] / frequency[i]));
  std::vector<std::size_t> gaps;
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    std::vector<double> beside;
    for (std::size_t k = i < 2 ? 0 : i - 2; k < std::min(ratios.size(), i + 3); ++k)
      if (k != i) beside.push_back(ratios[k]);
    if (beside.size() >= 2 && ratios[i] > gap_factor * median(beside)) gaps.push_back(i);
  }
  return gaps;
}

}  // namespace limcycle
