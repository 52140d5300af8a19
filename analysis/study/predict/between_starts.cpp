#include "limcycle/analysis/study/predict/between_starts.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/orbit/settle/displaced.hpp"

namespace limcycle {
namespace {

constexpr int bisections = 6;            ///< of one border
constexpr double close_enough = 1.1;     ///< ratio of two starts between which the search ends
constexpr double within_edge = 5.0;      ///< ratio of two starts between which an unstable cycle is searched for
constexpr double ratio_of_starts = 5.0;  ///< ratio of neighbouring starts if those of a user come to rest
constexpr double nudge = 1e-3;           ///< relative to the smallest swing of interest
constexpr double step_aside = 0.01;      ///< relative distance from an unstable cycle

/// The time between the third and the fifth turn of y: a motion that begins near an unstable cycle first follows it.
std::optional<double> first_period(const Trace& trace) {
  std::vector<double> turns;
  for (std::size_t i = 0; i + 1 < trace.t.size() && turns.size() < 5; ++i)
    if (trace.rate[i] * trace.rate[i + 1] < 0.0) turns.push_back(trace.t[i + 1]);
  if (turns.size() < 5) return std::nullopt;
  return turns[4] - turns[2];
}

}  // namespace

std::vector<double> places_between(double low, double high) {
  const double ratio = high / low;
  const int parts = std::max(1, static_cast<int>(std::lround(std::log(ratio) / std::log(ratio_of_starts))));
  std::vector<double> places;
  for (int part = parts - 1; part > 0; --part)
    places.push_back(low * std::pow(ratio, static_cast<double>(part) / parts));
  return places;
}

BetweenStarts::BetweenStarts(const Loop& loop, CycleHunt& hunt, long max_steps, const std::function<bool()>& stop)
    : loop_(loop), hunt_(hunt), left_(max_steps), stop_(stop) {}

OutcomeOfStart BetweenStarts::probe(const LoopState& start, std::string name, double smallest_swing) {
  const long before = hunt_.steps();
  OutcomeOfStart outcome = hunt_.probe_from(start, std::move(name), smallest_swing);
  left_ -= hunt_.steps() - before;
  return outcome;
}

/// True if an unstable cycle of about the size of these two starts is known: it is the border between them, and
/// look_beside_unstable_cycles() begins on either side of it.
bool BetweenStarts::knows_border(const Start& low, const Start& high) const {
  constexpr double about = 3.0;
  return std::ranges::any_of(hunt_.cycles(), [&](const Cycle& cycle) {
    return cycle.stable == false && cycle.amplitude > low.place / about && cycle.amplitude < about * high.place;
  });
}

/// Searches for an unstable cycle between the two places on the ray; true if it found one.
bool BetweenStarts::find_border(double low, double high, const Trace& diverging, const Ray& ray) {
  const auto period = first_period(diverging);
  if (!period) return false;
  const double middle = std::sqrt(low * high);
  const long before = hunt_.steps();
  const auto found = hunt_.edge_between([&](double scale) { return ray.state(scale * middle); }, *period);
  left_ -= hunt_.steps() - before;
  return found.has_value();
}

void BetweenStarts::bisect_divergence(const Start& low_start, const Start& high_start, const Ray& ray) {
  const bool below = hunt_.outcomes()[low_start.outcome].outcome == Outcome::divergence;
  double low = low_start.place, high = high_start.place;
  Trace diverging = hunt_.outcomes()[(below ? low_start : high_start).outcome].trace;
  bool sought = false;
  for (int k = 0; k < bisections && high > close_enough * low && !over(); ++k) {
    if (!sought && high < within_edge * low) {
      sought = true;
      if (find_border(low, high, diverging, ray)) return;
    }
    const double middle = std::sqrt(low * high);
    OutcomeOfStart outcome = probe(ray.state(middle), ray.name(middle));
    const bool also = outcome.outcome == Outcome::divergence;
    (also == below ? low : high) = middle;
    if (also) diverging = std::move(outcome.trace);
  }
}

void BetweenStarts::look_between(std::vector<Start> starts, const Ray& ray) {
  std::ranges::sort(starts, {}, &Start::place);
  const auto outcome = [&](const Start& start) { return hunt_.outcomes()[start.outcome].outcome; };
  const auto diverges = [&](const Start& start) { return outcome(start) == Outcome::divergence; };
  const auto is_calm = [](Outcome one) { return one == Outcome::rest || one == Outcome::sliding; };
  const auto calm = [&](const Start& start) { return is_calm(outcome(start)); };
  const bool sticks = loop_.ports.back().rubs && loop_.elements.back().may_stick();
  if (!starts.empty() && calm(starts.front())) {
    const double lowest = starts.front().place / ratio_of_starts;
    for (const double place : {lowest, nudge * hunt_.smallest_swing()}) {
      if (over() || place > lowest) break;
      if (!is_calm(probe(ray.state(place), ray.name(place)).outcome) || !sticks) break;
    }
  }
  for (std::size_t i = 0; i + 1 < starts.size(); ++i) {
    const Start &low = starts[i], &high = starts[i + 1];
    if (diverges(low) != diverges(high) && !knows_border(low, high)) bisect_divergence(low, high, ray);
    if (!calm(low) || !calm(high)) continue;
    for (const double place : places_between(low.place, high.place)) {
      if (over()) break;
      probe(ray.state(place), ray.name(place), low.place);
    }
  }
}

std::vector<std::size_t> BetweenStarts::look_beside_unstable_cycles() {
  std::vector<std::size_t> undecided;
  for (; looked_at_ < hunt_.cycles().size() && !over(); ++looked_at_) {
    const Cycle cycle = hunt_.cycles()[looked_at_];  // a copy: the list grows
    if (cycle.stable != false) continue;
    const std::string which = "the unstable cycle " + std::to_string(looked_at_);
    bool decided = false;
    for (const bool inside : {true, false}) {
      if (over()) return undecided;
      const LoopState start = scaled(loop_, cycle.start, inside ? 1.0 - step_aside : 1.0 + step_aside);
      const auto outcome = probe(start, std::string(inside ? "just inside " : "just outside ") + which);
      decided = decided || outcome.outcome != Outcome::undecided;
    }
    if (!decided) undecided.push_back(looked_at_);
  }
  return undecided;
}

}  // namespace limcycle
