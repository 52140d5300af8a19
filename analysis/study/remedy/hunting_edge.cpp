#include "limcycle/analysis/study/remedy/hunting_edge.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "limcycle/analysis/study/predict/interest.hpp"

namespace limcycle {
namespace {

/// A value with few digits, not nearer to `other` than `value` is.
double rounded_away(double value, double other) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  // A power of ten with a negative exponent is no binary number: divided by its inverse the result is the nearest.
  const double places = edge_digits - 1 - std::floor(std::log10(std::abs(value))),
               unit = std::pow(10.0, std::abs(places));
  const double in_units = places > 0.0 ? value * unit : value / unit;
  const double whole = value > other ? std::ceil(in_units) : std::floor(in_units);
  return places > 0.0 ? whole / unit : whole * unit;
}

double distance(const Bracket& bracket) { return std::abs(std::log(bracket.rests / bracket.hunts)); }

}  // namespace

double HuntingSizes::of(Measure measure) const {
  switch (measure) {
    case Measure::displacement:
      return displacement;
    case Measure::force:
      return force;
    case Measure::stiffness:
      return force / displacement;
    case Measure::damping:
      return force / (displacement * frequency);
    case Measure::rate:
      return frequency;
    case Measure::own:
      break;
  }
  return 1.0;
}

std::optional<Loop> HuntingEdge::loop_at(double value) const {
  const auto parts = candidate_.parts(value);
  return parts ? std::optional(build_loop(*parts)) : std::nullopt;
}

/// A cycle may be stable where no start of predict() comes upon it.
Hunts HuntingEdge::from_last_hunting(const Loop& loop, const SearchBox& box) {
  const auto settled = hunting ? settled_from(loop, *hunting, box, loop_.judging.predict) : std::nullopt;
  if (!settled) return Hunts::no;
  const Hunts answer = hunts_of(*settled);
  if (answer == Hunts::yes && settled->outcome == Outcome::cycle) hunting->state = settled->shot->cycle.start;
  return answer;
}

Hunts HuntingEdge::judged(double value, Care care) {
  const auto loop = loop_at(value);
  if (!loop) return Hunts::undecided;
  Hunts last = Hunts::no;
  const SearchBox& box = *loop_.judging.predict.search;
  if (care == Care::quick) {
    last = from_last_hunting(*loop, box);
    if (last != Hunts::no) return last;
  }
  Judging judging = care == Care::quick ? hurried(loop_.judging) : loop_.judging;
  if (care == Care::for_rest)
    judging.predict.enough = [](const OutcomeOfStart& one) { return one.outcome == Outcome::undecided; };
  HuntsAnswer answer = hunts(*loop, judging);
  for (const Cycle& one : answer.found.cycles)
    if (one.stable == true) hunting = motion_state(one, *loop);
  if (care == Care::quick || answer.hunts != Hunts::no) return answer.hunts;
  if (!answer.found.outcomes.empty()) run = std::move(answer.found.outcomes.front().trace);
  last = from_last_hunting(*loop, box);
  return last == Hunts::no ? from_own_starts(*loop) : last;
}

/// From the starts that predict() takes of itself: those of the loop without the remedy may be others.
Hunts HuntingEdge::from_own_starts(const Loop& loop) {
  if (loop_.box_is_given) return Hunts::no;  // these are the same
  Judging judging = loop_.judging;
  judging.predict.search.reset();
  const HuntsAnswer answer = hunts(loop, judging);
  bool any = std::ranges::any_of(answer.found.outcomes,
                                 [](const OutcomeOfStart& one) { return one.outcome == Outcome::irregular; });
  for (const Cycle& one : answer.found.cycles) {
    if (one.stable != true || !is_of_interest(*loop_.judging.predict.search, one)) continue;
    hunting = motion_state(one, loop);
    any = true;
  }
  return any ? Hunts::yes : Hunts::no;
}

/// Moves either side away from the other until predict() judges both as they should be.
bool HuntingEdge::widen(Bracket& bracket) {
  constexpr int widenings = 7;
  const double factor = bracket.rests / bracket.hunts, middle = bracket.hunts * std::sqrt(factor);
  double apart = std::max(std::sqrt(std::max(factor, 1.0 / factor)), 1.0 + 0.25 * narrow_enough) - 1.0;
  const bool outward = factor > 1.0;
  const auto at = [&](double distance, bool to_rest) {
    const double value = to_rest == outward ? middle * (1.0 + distance) : middle / (1.0 + distance);
    return rounded_away(value, middle);
  };
  const auto find = [&](bool to_rest, double& side) {
    double distance = apart;
    for (int i = 0; i < widenings && !stopped(); ++i, distance *= 2.5) {
      const double value = at(distance, to_rest);
      const Hunts here = judged(value, to_rest ? Care::for_rest : Care::full);
      const bool rests = here == Hunts::no, moves = here == Hunts::yes || here == Hunts::diverges;
      if (to_rest ? rests : moves) {
        side = value;
        return true;
      }
      if (here == Hunts::undecided) undecided_ = value;
      if (!to_rest && rests) bracket.rests = value;
      if (to_rest && moves) bracket.hunts = value;
    }
    return false;
  };
  bool hunts_beyond = false;
  const double before = bracket.hunts;
  if (!find(true, bracket.rests)) return false;
  hunts_beyond = bracket.hunts != before;
  return hunts_beyond || find(false, bracket.hunts);
}

/// Both sides judged by predict(), and 1e-3 apart, or a little more if it does not decide the values between them.
bool HuntingEdge::confirm(Bracket& bracket) {
  constexpr int rounds = 4;
  for (int i = 0; i < rounds; ++i) {
    if (!widen(bracket)) return false;
    bracket.has_gap = !narrow(bracket);
    if (bracket.has_gap && (stopped() || distance(bracket) > wide_enough)) return false;
    if (!look_beyond(bracket)) return !stopped();
  }
  return false;
}

std::optional<Bracket> HuntingEdge::well_apart(const Bracket& bracket) {
  constexpr std::array factors{1.02, 1.1, 1.3, 2.0};
  const double outward = bracket.rests / bracket.hunts > 1.0 ? 1.0 : -1.0;
  const auto place = [&](double from, double factor) { return rounded_away(from * std::pow(factor, outward), from); };
  Bracket wide = bracket;
  const auto rests = std::ranges::find_if(factors, [&](double factor) {
    wide.rests = place(bracket.rests, factor);
    const double beyond = wide.rests * std::pow(1.1, outward);
    return !stopped() && candidate_.parts(wide.rests) && judged(wide.rests, Care::for_rest) == Hunts::no &&
           (!candidate_.parts(beyond) || judged(beyond, Care::for_rest) == Hunts::no);
  });
  if (rests == factors.end()) return std::nullopt;
  const auto hunts = std::ranges::find_if(factors, [&](double factor) {
    wide.hunts = place(bracket.hunts, 1.0 / factor);
    return !stopped() && judged(wide.hunts) == Hunts::yes;
  });
  if (hunts == factors.end()) return std::nullopt;
  judged(wide.rests);  // for its run
  wide.has_gap = true;
  return wide;
}

/// True if it hunts again just beyond an edge: the bracket is moved there.
bool HuntingEdge::look_beyond(Bracket& bracket) {
  for (const double farther : {1.03, 1.1}) {
    const bool outward = bracket.rests / bracket.hunts > 1.0;
    const double value = bracket.rests * std::pow(farther, outward ? 1.0 : -1.0);
    if (stopped() || !candidate_.parts(value)) return false;
    if (judged(value) != Hunts::yes) continue;
    bracket.hunts = value;
    bracket.rests = value * (outward ? 1.001 : 0.999);
    return true;
  }
  return false;
}

/// By bisection; true if the sides are near each other in the end.
bool HuntingEdge::narrow(Bracket& bracket) {
  while (distance(bracket) > 1.5 * narrow_enough) {
    if (stopped()) return false;
    const double middle = bracket.hunts * std::sqrt(bracket.rests / bracket.hunts);
    const double value = rounded_away(middle, bracket.hunts);
    if (value == bracket.rests) break;
    if (value == undecided_) return false;
    const Hunts here = judged(value);
    if (here == Hunts::undecided || here == Hunts::neutral) return false;
    (here == Hunts::no ? bracket.rests : bracket.hunts) = value;
  }
  return true;
}

}  // namespace limcycle
