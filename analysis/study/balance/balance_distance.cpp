#include "limcycle/analysis/study/balance/balance_distance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace limcycle {
namespace {

constexpr int cells = 40;  ///< cells over each side of the box
constexpr int seeds = 4;   ///< best points of the grid that are refined
constexpr double finest = 1e-6;
constexpr double tight = 1e-9;  ///< accuracy of the describing functions of the pattern search

struct Place {
  double a, w;  ///< ln A, ln w
  double value;
};

class Search {
 public:
  Search(const Loop& loop, const SearchBox& box, const std::function<bool()>& stop)
      : balance_(loop), box_(box), stop_(stop) {}

  bool stopped() const { return stop_ && stop_(); }

  double value(double a, double w, double accuracy) const {
    const auto f = balance_(std::exp(a), std::exp(w), accuracy);
    const double size = std::abs(f - 1.0);
    return std::isfinite(f.real()) && std::isfinite(f.imag()) && size > 0.0 ? std::abs(f) / size : infinite;
  }
  Place place(double a, double w, double accuracy) const { return {a, w, value(a, w, accuracy)}; }

  bool inside(double a, double w) const {
    return a >= std::log(box_.amplitude_min) && a <= std::log(box_.amplitude_max) &&
           w >= std::log(box_.frequency_min) && w <= std::log(box_.frequency_max);
  }

  /// Moves along the axes and the diagonals, with twice the step after a move that lowers the distance by more than its
  /// own error and half the step after none.
  Place refined(Place best, double step) const {
    const double longest = step;
    best.value = value(best.a, best.w, tight);
    while (step > finest && !stopped()) {
      Place next = best;
      for (const auto& [da, dw] : std::vector<std::pair<double, double>>{
               {1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}) {
        if (!inside(best.a + step * da, best.w + step * dw)) continue;
        const Place trial = place(best.a + step * da, best.w + step * dw, tight);
        if (trial.value < next.value) next = trial;
      }
      const bool lower = next.value < best.value * (1.0 - tight);
      if (lower) best = next;
      step = lower ? std::min(2.0 * step, longest) : 0.5 * step;
    }
    return best;
  }

 private:
  FirstHarmonicBalance balance_;
  SearchBox box_;
  const std::function<bool()>& stop_;
};

}  // namespace

std::optional<BalanceDistance> balance_distance(const Loop& loop, const SearchBox& box,
                                                const std::function<bool()>& stop,
                                                const std::vector<BalanceDistance>& roots) {
  if (FirstHarmonicBalance::not_applicable(loop)) return std::nullopt;
  const Search search(loop, box, stop);
  const double a0 = std::log(box.amplitude_min), w0 = std::log(box.frequency_min);
  const double da = (std::log(box.amplitude_max) - a0) / cells, dw = (std::log(box.frequency_max) - w0) / cells;
  std::vector<Place> places;
  for (int i = 0; i <= cells; ++i)
    for (int k = 0; k <= cells; ++k) {
      if (search.stopped()) return std::nullopt;
      places.push_back(search.place(a0 + da * i, w0 + dw * k, 1e-4));
    }
  for (const BalanceDistance& root : roots)
    if (const double a = std::log(root.amplitude), w = std::log(root.frequency); search.inside(a, w))
      places.push_back(search.place(a, w, tight));
  std::ranges::sort(places, {}, &Place::value);
  if (!std::isfinite(places.front().value)) return std::nullopt;
  Place best = places.front();
  best.value = infinite;
  for (int i = 0; i < seeds && std::isfinite(places[static_cast<std::size_t>(i)].value); ++i) {
    const Place found = search.refined(places[static_cast<std::size_t>(i)], 0.5 * std::max(da, dw));
    if (search.stopped()) return std::nullopt;
    if (found.value < best.value) best = found;
  }
  return BalanceDistance{best.value, std::exp(best.a), std::exp(best.w)};
}

}  // namespace limcycle
