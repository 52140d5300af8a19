#include "limcycle/analysis/orbit/settle/irregular.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include "limcycle/analysis/orbit/settle/watch/outcome_watch.hpp"

namespace limcycle {
namespace {

constexpr std::size_t part_count = 4;
constexpr double range_scatter = 0.15, spread_scatter = 0.15, returns_scatter = 0.2;  // largest scatter of the parts
constexpr double one_way = 0.02;  // upper limit of a monotonic change of the spread

/// One part of a motion.
struct Part {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  double sum = 0.0, square = 0.0, time = 0.0;  ///< integrals of y, y^2 and 1
  long returns = 0;

  /// Adds a step of length h, with y linear over it.
  void add(double h, double y0, double y1) {
    low = std::min(low, y1);
    high = std::max(high, y1);
    sum += 0.5 * h * (y0 + y1);
    square += h * (y0 * y0 + y0 * y1 + y1 * y1) / 3.0;
    time += h;
  }
  double range() const { return high - low; }
  double spread() const { return std::sqrt(std::max(0.0, square / time - (sum / time) * (sum / time))); }
};

/// Largest over least of a number of the parts, less 1.
template <class F>
double scatter(const std::array<Part, part_count>& all, const F& number) {
  const auto [least, most] = std::ranges::minmax(all, {}, number);
  return std::invoke(number, most) / std::invoke(number, least) - 1.0;
}

bool goes_one_way(const std::array<Part, part_count>& all) {
  const bool falls = std::ranges::is_sorted(all, std::ranges::greater{}, &Part::spread);
  const bool rises = std::ranges::is_sorted(all, std::ranges::less{}, &Part::spread);
  return (falls || rises) && scatter(all, &Part::spread) > one_way;
}

/// Upward crossings of a level, and the largest and the least y between each and the next.
struct Returns {
  std::vector<double> times, peaks, troughs;
  double mean() const { return (times.back() - times.front()) / static_cast<double>(times.size() - 1); }
  std::vector<double> periods() const {
    std::vector<double> all;
    for (std::size_t i = 1; i < times.size(); ++i) all.push_back(times[i] - times[i - 1]);
    return all;
  }
  /// Half of largest less least y of each; the last one is not complete.
  std::vector<double> amplitudes() const {
    std::vector<double> all;
    for (std::size_t i = 0; i + 1 < times.size(); ++i) all.push_back(0.5 * (peaks[i] - troughs[i]));
    return all;
  }
};

Returns returns_to(double level, const Trace& trace, std::size_t from) {
  Returns found;
  for (std::size_t i = from; i < trace.t.size(); ++i) {
    const OutputStep step =
        OutputStep::through(trace.t[i - 1], trace.t[i], trace.y[i - 1], trace.y[i], trace.rate[i - 1], trace.rate[i]);
    if (step.y0 < level && step.y1 >= level) {
      found.times.push_back(step.crossing(level));
      found.peaks.push_back(step.y1);
      found.troughs.push_back(step.y1);
    } else if (!found.peaks.empty()) {
      const bool turns = trace.rate[i - 1] * trace.rate[i] < 0.0 || trace.rate[i] == 0.0;
      const double y = turns ? step.turning().y : step.y1;
      found.peaks.back() = std::max(found.peaks.back(), y);
      found.troughs.back() = std::min(found.troughs.back(), y);
    }
  }
  return found;
}

/// The least number of returns after which they repeat themselves; 0 if they do not.
std::size_t repeat_lag(const Returns& returns, double range, double same) {
  if (returns.times.size() < 4) return 0;
  const std::size_t n = returns.times.size() - 1;  // the last peak may not be complete
  const double mean = returns.mean();
  for (std::size_t lag = 1; lag <= n / 3; ++lag) {
    bool all = true;
    for (std::size_t i = 0; i + lag < n && all; ++i)
      all = std::abs(returns.peaks[i + lag] - returns.peaks[i]) <= same * range &&
            std::abs(returns.times[i + lag + 1] - returns.times[i + lag] - returns.times[i + 1] + returns.times[i]) <=
                same * mean;
    if (all) return lag;
  }
  return 0;
}

/// True if the returns repeat themselves after some number of them. Then the motion is periodic, though shooting did
/// not find the cycle.
bool repeats(const Returns& returns, double range) {
  constexpr double same = 3e-4;  // resolution of the steps of a run
  return repeat_lag(returns, range, same) > 0;
}

/// True if the first part reaches farther than the others, which are alike: the motion was still settling.
bool settles_in_first(const std::array<Part, part_count>& all) {
  constexpr double farther = 0.03, times = 3.0;
  const auto [least, most] = std::ranges::minmax(std::span(all).subspan(1), {}, &Part::range);
  const double apart = most.range() / least.range() - 1.0;
  return all.front().range() > most.range() * (1.0 + std::max(farther, times * apart));
}

/// permanent_motion() of what follows that share of the record.
std::optional<IrregularMotion> motion_after(double share, const Trace& trace, bool may_repeat, long fewest_returns) {
  const double end = trace.t.back(), begin = trace.t.front() + share * (end - trace.t.front());
  std::array<Part, part_count> all;
  const auto part_at = [&](double t) -> Part& {
    const auto k = static_cast<std::size_t>(static_cast<double>(part_count) * (t - begin) / (end - begin));
    return all[std::min(k, part_count - 1)];
  };
  const auto from =
      static_cast<std::size_t>(std::ranges::lower_bound(trace.t, begin) - trace.t.begin()) + 1;  // first whole step
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = from; i < trace.t.size(); ++i) {
    part_at(trace.t[i]).add(trace.t[i] - trace.t[i - 1], trace.y[i - 1], trace.y[i]);
    low = std::min(low, trace.y[i]);
    high = std::max(high, trace.y[i]);
  }
  const Returns returns = returns_to(0.5 * (low + high), trace, from);
  for (const double t : returns.times) ++part_at(t).returns;
  const auto is_short = [&](const Part& part) { return part.returns < fewest_returns || !(part.time > 0.0); };
  if (std::ranges::any_of(all, is_short)) return std::nullopt;
  const auto [fewest, most] = std::ranges::minmax(all, {}, &Part::returns);
  const double uneven = std::max(1.0, returns_scatter * static_cast<double>(fewest.returns));
  if (scatter(all, &Part::range) > range_scatter || scatter(all, &Part::spread) > spread_scatter ||
      static_cast<double>(most.returns - fewest.returns) > uneven)
    return std::nullopt;
  if (goes_one_way(all) || (!may_repeat && repeats(returns, high - low))) return std::nullopt;
  constexpr double later = 0.5;
  if (share < later && settles_in_first(all))
    if (auto settled = motion_after(later, trace, may_repeat, fewest_returns)) return settled;
  const std::vector<double> sizes = returns.amplitudes();
  const auto [shortest, longest] = std::ranges::minmax(returns.periods());
  const auto [smallest, largest] = std::ranges::minmax(sizes);
  return IrregularMotion{0.5 * (high - low),
                         returns.mean(),
                         shortest,
                         longest,
                         returns.times.back() - returns.times.front(),
                         std::accumulate(sizes.begin(), sizes.end(), 0.0) / static_cast<double>(sizes.size()),
                         smallest,
                         largest,
                         0.0};
}

}  // namespace

std::optional<IrregularMotion> permanent_motion(const Trace& trace, bool may_repeat, long fewest_returns) {
  if (trace.t.size() < 1000) return std::nullopt;
  return motion_after(1.0 / 3.0, trace, may_repeat, fewest_returns);
}

double repeat_time(const Trace& trace) {
  constexpr double same = 1e-7;
  if (trace.t.size() < 10) return 0.0;
  const double begin = trace.t.front() + (trace.t.back() - trace.t.front()) / 3.0;
  const auto from = static_cast<std::size_t>(std::ranges::lower_bound(trace.t, begin) - trace.t.begin()) + 1;
  if (from >= trace.t.size()) return 0.0;
  const auto [low, high] =
      std::ranges::minmax_element(trace.y.begin() + static_cast<std::ptrdiff_t>(from), trace.y.end());
  const Returns returns = returns_to(0.5 * (*low + *high), trace, from);
  const std::size_t lag = repeat_lag(returns, *high - *low, same);
  return lag > 0 ? returns.times.back() - returns.times[returns.times.size() - 1 - lag] : 0.0;
}

double beat_frequency(const IrregularMotion& motion, double repetition) {
  if (!(motion.longest_period - motion.shortest_period < repetition)) return 0.0;
  const double turns = motion.mean_period / repetition, beats = std::abs(turns - std::round(turns));
  constexpr double fewest = 2.0;
  if (!(beats * motion.observed >= fewest * motion.mean_period)) return 0.0;
  return 2.0 * std::numbers::pi * beats / motion.mean_period;
}

bool agree(const IrregularMotion& one, const IrregularMotion& other) {
  constexpr double enough = 0.05;
  return std::abs(one.half_range / other.half_range - 1.0) <= enough &&
         std::abs(one.mean_period / other.mean_period - 1.0) <= enough;
}

}  // namespace limcycle
