#include "limcycle/analysis/orbit/settle/drift.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "limcycle/analysis/motion/field/loop_field.hpp"
#include "limcycle/analysis/motion/tolerances.hpp"
#include "limcycle/analysis/motion/typical_sizes.hpp"
#include "limcycle/analysis/orbit/cycle/return_map.hpp"

namespace limcycle {
namespace {

constexpr std::array tolerances{1e-8, 1e-9, 1e-10, 1e-11, 1e-12};  ///< of the map
constexpr double resolved = 1e4;                                   ///< drift in units of that tolerance
constexpr double slow = 0.02, farthest = 0.05;  ///< drift of a period, and of a leap, in sizes of the motion
constexpr double one_direction = 0.985;         ///< cosine
constexpr double first_leap = 0.2, longest_leap = 0.5, shortest_leap = 0.02;  ///< in periods of |g - 1|
constexpr double well_foretold = 0.2, refused = 0.5;                          ///< errors of a drift after a leap
constexpr double still_alike = 0.3;  ///< way of all leaps in sizes of the motion, which are those of its beginning
constexpr int fewest_periods = 4;

/// Largest less least value of each state in a time; of one that stands still, its typical size.
State ranges(const Loop& loop, const LoopState& from, double time, long most_steps) {
  LoopField field(loop);
  field.modes() = from.modes;
  March march(field, StepperKind::automatic, loop_weights(loop, tolerances.front()));
  march.begin(from.x, 0.0);
  State low = from.x, high = from.x;
  while (march.t() < time && march.steps() < most_steps && march.step(time) == Status::converged)
    for (std::size_t i = 0; i < low.size(); ++i) {
      low[i] = std::min(low[i], march.x()[i]);
      high[i] = std::max(high[i], march.x()[i]);
    }
  const State typical = typical_sizes(loop);
  for (std::size_t i = 0; i < low.size(); ++i) low[i] = high[i] > low[i] ? high[i] - low[i] : typical[i];
  return low;
}

/// The map of a motion that drifts, and its leaps.
class Leaps {
 public:
  Leaps(const Loop& loop, const NearlyClosed& motion, const ShootingOptions& options)
      : map_(map_of(loop, motion, options)),
        sizes_(ranges(loop, motion.here, motion.period.t.back() - motion.period.t.front(), map_.options().max_steps)) {}

  Drift follow(const LoopState& here) {
    Drift drift;
    if (begin(here))
      for (const State from = now_.state.x; distance(from, now_.state.x) < still_alike && leap();) {
        drift.to = now_.state;
        drift.time = now_.time;
      }
    drift.steps = map_.steps();
    return drift;
  }

 private:
  /// A state, and the drift that led to it in one period.
  struct Place {
    LoopState state;
    double time = 0.0, period = 0.0;
    State drift;        ///< in sizes of the motion
    double size = 0.0;  ///< of the drift
  };

  static ReturnMap map_of(const Loop& loop, const NearlyClosed& motion, const ShootingOptions& options) {
    const double period = motion.period.t.back() - motion.period.t.front();
    const Section section = choose_section(loop, motion.period);
    ReturnMap::Options of_map{tolerances.front(), std::max(2000L, 200 * motion.steps), options.stop};
    of_map.longest = 3.0 * period;
    of_map.returns = returns_of(section, motion.period);
    return {loop, section, std::nullopt, of_map};
  }

  /// One period on.
  std::optional<Place> after(const LoopState& from, double time) {
    auto at = map_(from);
    if (at.status != Status::converged || at.state.modes != from.modes) return std::nullopt;
    Place place{std::move(at.state), time + at.time, at.time, State(from.x.size())};
    for (std::size_t i = 0; i < from.x.size(); ++i) place.drift[i] = (place.state.x[i] - from.x[i]) / sizes_[i];
    place.size = distance(place.state.x, from.x);
    return place;
  }

  /// Two periods on: in the first one other deviations than the drift die out.
  std::optional<Place> relaxed_after(const LoopState& from, double time) {
    const auto relaxed = after(from, time);
    return relaxed ? after(relaxed->state, relaxed->time) : std::nullopt;
  }

  /// In sizes of the motion.
  double distance(const State& one, const State& other) const {
    double square = 0.0;
    for (std::size_t i = 0; i < one.size(); ++i) square += std::pow((one[i] - other[i]) / sizes_[i], 2);
    return std::sqrt(square);
  }

  static double cosine(const Place& one, const Place& other) {
    return std::inner_product(one.drift.begin(), one.drift.end(), other.drift.begin(), 0.0) / (one.size * other.size);
  }

  /// With the loosest tolerance that resolves the drift; false if none does, or if there is no slow drift along one
  /// direction.
  bool begin(const LoopState& here) {
    for (std::size_t level = 0; level < tolerances.size(); ++level) {
      set_level(level);
      const auto at = map_.approach(here);
      const auto first = at.status == Status::converged ? relaxed_after(at.state, at.time) : std::nullopt;
      const auto second = first ? after(first->state, first->time) : std::nullopt;
      if (!second || second->size > slow) return false;
      if (!is_resolved(*second)) continue;
      growth_ = second->size / first->size;
      now_ = *second;
      return cosine(*first, *second) > one_direction;
    }
    return false;
  }

  bool is_resolved(const Place& place) const { return place.size > resolved * tolerances[level_]; }

  void set_level(std::size_t level) {
    level_ = level;
    map_.set_rtol(tolerances[level]);
  }

  /// A drift that has grown needs no tolerance as tight as before, one that has shrunk a tighter one.
  void adapt_tolerance() {
    constexpr double small = 3.0, large = 30.0;
    const double units = now_.size / (resolved * tolerances[level_]);
    const std::size_t before = level_;
    if (units > large && before > 0)
      set_level(before - 1);
    else if (units < small && before + 1 < tolerances.size())
      set_level(before + 1);
    else
      return;
    const auto place = relaxed_after(now_.state, now_.time);
    if (place && cosine(*place, now_) > one_direction)
      now_ = *place;
    else
      set_level(before);
  }

  /// Leaps, over fewer periods until what follows is as foretold; false if no leap is long enough for it.
  bool leap() {
    adapt_tolerance();
    for (; share_ >= shortest_leap; share_ *= 0.25) {
      const double periods = std::floor(std::min({share_ / std::abs(growth_ - 1.0), farthest / now_.size, 1e6}));
      if (periods < fewest_periods) return false;
      const auto place = beyond(periods);
      if (!place || place->size > slow || !is_resolved(*place) || cosine(*place, now_) < one_direction) continue;
      const double foretold = now_.size * std::pow(growth_, periods + 2.0),
                   deviation = std::abs(place->size / foretold - 1.0);
      if (deviation > refused) continue;
      share_ = std::min(deviation > well_foretold ? 0.5 * share_ : 2.0 * share_, longest_leap);
      growth_ = std::pow(place->size / now_.size, 1.0 / (periods + 2.0));
      now_ = *place;
      return true;
    }
    return false;
  }

  /// Two periods after a leap.
  std::optional<Place> beyond(double periods) {
    const double g = growth_;
    const double sum = std::abs(g - 1.0) < 1e-9 ? periods : g * std::expm1(periods * std::log(g)) / (g - 1.0);
    LoopState from = now_.state;
    for (std::size_t i = 0; i < from.x.size(); ++i) from.x[i] += sum * now_.drift[i] * sizes_[i];
    return relaxed_after(from, now_.time + periods * now_.period);
  }

  ReturnMap map_;
  State sizes_;
  Place now_;
  std::size_t level_ = 0;  ///< of the tolerances
  double growth_ = 1.0, share_ = first_leap;
};

}  // namespace

Drift follow_drift(const Loop& loop, const NearlyClosed& motion, const ShootingOptions& options) {
  return Leaps(loop, motion, options).follow(motion.here);
}

}  // namespace limcycle
