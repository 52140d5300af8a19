#include "limcycle/analysis/study/predict/interest.hpp"

#include <algorithm>

#include "limcycle/analysis/short_number.hpp"

namespace limcycle {
namespace {

constexpr double border_width = 1e-6;  ///< relative width of the border of a box

/// Half the range of the element's input over the cycle; that of y if the cycle has no trace.
double input_amplitude(const Cycle& cycle) {
  if (cycle.trace.input.empty()) return cycle.amplitude;
  const auto [low, high] = std::ranges::minmax(cycle.trace.input);
  return 0.5 * (high - low);
}

bool is_too_small(const SearchBox& box, const Cycle& cycle) {
  return input_amplitude(cycle) < box.amplitude_min * (1.0 - border_width);
}

std::string outside(const SearchBox& box, const Cycle& cycle) {
  if (is_too_small(box, cycle))
    return "the amplitude " + short_number(input_amplitude(cycle)) + " of the element's input is below " +
           short_number(box.amplitude_min);
  const double w = cycle.frequency();
  return "the frequency " + short_number(w) + " rad/s is " +
         (w < box.frequency_min ? "below " + short_number(box.frequency_min)
                                : "above " + short_number(box.frequency_max)) +
         " rad/s";
}

/// The box, widened by a factor of 10 where the cycle is outside.
void widen(SearchBox& box, const Cycle& cycle) {
  constexpr double room = 10.0;
  if (is_too_small(box, cycle)) box.amplitude_min = input_amplitude(cycle) / room;
  if (cycle.frequency() < box.frequency_min) box.frequency_min = cycle.frequency() / room;
  if (cycle.frequency() > box.frequency_max) box.frequency_max = cycle.frequency() * room;
}

}  // namespace

bool is_of_interest(const SearchBox& box, const Cycle& cycle) {
  if (!(box.frequency_max > 0.0)) return true;  // no box at all
  const double w = cycle.frequency();
  return !is_too_small(box, cycle) && w >= box.frequency_min * (1.0 - border_width) &&
         w <= box.frequency_max * (1.0 + border_width);
}

std::vector<std::string> compare_with_interest(const std::vector<Cycle>& cycles, bool given, SearchBox& box) {
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    if (is_of_interest(box, cycles[i])) continue;
    const std::string name = "cycle " + std::to_string(i), why = outside(box, cycles[i]);
    if (given) {
      notes.push_back(name + " is outside the search range of the case (" + why +
                      "); it is listed, but does not count as hunting");
    } else {
      notes.push_back(name + " was outside the default search range (" + why + "), which was widened to include it");
      widen(box, cycles[i]);
    }
  }
  return notes;
}

}  // namespace limcycle
