#include "limcycle/analysis/study/tune/tune_space.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "limcycle/analysis/study/sensitivity/global/sobol_design.hpp"

namespace limcycle {

double with_four_digits(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, 3).ptr;
  std::from_chars(text, end, value);
  return value;
}

double distance_between(std::span<const double> a, std::span<const double> b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

TuneSpace::TuneSpace(std::span<const TuneNumber> numbers) {
  for (const TuneNumber& one : numbers) sides_.push_back({one.low, one.high, one.low * one.high > 0.0});
}

std::vector<double> TuneSpace::values(std::span<const double> place) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const auto& [low, high, logarithmic] = sides_[i];
    const double share = place[i];
    if (share <= 0.0)
      values.push_back(low);
    else if (share >= 1.0)
      values.push_back(high);
    else
      values.push_back(std::clamp(
          with_four_digits(logarithmic ? low * std::pow(high / low, share) : low + share * (high - low)), low, high));
  }
  return values;
}

std::vector<double> TuneSpace::place(std::span<const double> values) const {
  std::vector<double> place;
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const auto& [low, high, logarithmic] = sides_[i];
    const double share =
        logarithmic ? std::log(values[i] / low) / std::log(high / low) : (values[i] - low) / (high - low);
    place.push_back(std::clamp(share, 0.0, 1.0));
  }
  return place;
}

bool TuneSpace::contains(std::span<const double> values) const {
  for (std::size_t i = 0; i < sides_.size(); ++i)
    if (!(values[i] >= sides_[i].low && values[i] <= sides_[i].high)) return false;
  return true;
}

std::vector<std::vector<double>> TuneSpace::beside(std::span<const double> values, double share, double of_side) const {
  std::vector<std::vector<double>> all;
  for (std::size_t i = 0; i < sides_.size(); ++i)
    for (const double sign : {-1.0, 1.0}) {
      std::vector<double> other(values.begin(), values.end());
      const double by = values[i] != 0.0 ? share * std::abs(values[i]) : of_side * (sides_[i].high - sides_[i].low);
      other[i] = with_four_digits(values[i] + sign * by);
      all.push_back(other[i] != values[i] && contains(other) ? std::move(other) : std::vector<double>());
    }
  return all;
}

std::vector<std::vector<double>> TuneSpace::design(std::size_t samples, std::uint64_t seed) const {
  constexpr double beyond = 1.0 / 14.0;  // each end of an interval of 8/7: a sixteenth of it
  const SobolDesign sobol(size(), samples, false, seed);
  std::vector<std::vector<double>> places;
  for (std::size_t k = 0; k < samples; ++k) {
    auto place = sobol.row(sobol.row_a(k));
    for (double& share : place) share = std::clamp((1.0 + 2.0 * beyond) * share - beyond, 0.0, 1.0);
    places.push_back(std::move(place));
  }
  return places;
}

}  // namespace limcycle
