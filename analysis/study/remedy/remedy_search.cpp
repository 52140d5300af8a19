#include "limcycle/analysis/study/remedy/remedy_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/continuation/margin_side.hpp"
#include "limcycle/analysis/study/predict/in_exact_time.hpp"

namespace limcycle {
namespace {

constexpr double widest_factor = 100.0;  ///< factor on the present value, or on the size of an absent one, either way
constexpr int a_decade = 3;
constexpr double narrow_enough = 1e-3;  ///< relative distance of the two sides of an edge
constexpr long steps_a_branch = 1'500'000;
constexpr int digits = 4;  ///< of the values that are tried at an edge

/// A value with few digits, not nearer to `other` than `value` is.
double rounded_away(double value, double other) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  // A power of ten with a negative exponent is no binary number: divided by its inverse the result is the nearest.
  const double places = digits - 1 - std::floor(std::log10(std::abs(value))), unit = std::pow(10.0, std::abs(places));
  const double in_units = places > 0.0 ? value * unit : value / unit;
  const double whole = value > other ? std::ceil(in_units) : std::floor(in_units);
  return places > 0.0 ? whole / unit : whole * unit;
}

bool is_outward(double value, double from) { return std::abs(value) > std::abs(from); }

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

RemedySearch::RemedySearch(const RemedyCandidate& candidate, const HuntingLoop& loop,
                           std::function<void(double)> progress)
    : candidate_(candidate),
      loop_(loop),
      size_(candidate.own != 0.0 ? candidate.own : loop.sizes.of(candidate.measure)),
      progress_(std::move(progress)) {}

std::string RemedySearch::number(double value, int shown) const {
  return short_number(value, shown) + (candidate_.unit == "1" ? "" : " " + candidate_.unit);
}

std::optional<Loop> RemedySearch::loop_at(double value) const {
  const auto parts = candidate_.parts(value);
  return parts ? std::optional(build_loop(*parts)) : std::nullopt;
}

/// A cycle may be stable where no start of predict() comes upon it.
Hunts RemedySearch::from_last_hunting(const Loop& loop, const SearchBox& box) {
  const auto settled = hunting_ ? settled_from(loop, *hunting_, box, loop_.judging.predict) : std::nullopt;
  if (!settled) return Hunts::no;
  const Hunts answer = hunts_of(*settled);
  if (answer == Hunts::yes && settled->outcome == Outcome::cycle) hunting_ = settled->shot->cycle.start;
  return answer;
}

Hunts RemedySearch::judged(double value, Care care) {
  const auto loop = loop_at(value);
  if (!loop) return Hunts::undecided;
  Hunts last = Hunts::no;
  const SearchBox& box = *loop_.judging.predict.search;
  if (care == Care::quick) {
    last = from_last_hunting(*loop, box);
    if (last != Hunts::no) return last;
  }
  Judging judging = loop_.judging;
  if (care == Care::quick) {
    judging.predict.starts = std::min(judging.predict.starts, 2);
    judging.predict.load_step = false;
  }
  HuntsAnswer answer = hunts(*loop, judging);
  for (const Cycle& one : answer.found.cycles)
    if (one.stable == true) hunting_ = one.start;
  if (care == Care::quick || answer.hunts != Hunts::no) return answer.hunts;
  if (!answer.found.outcomes.empty()) run_ = std::move(answer.found.outcomes.front().trace);
  return from_last_hunting(*loop, box);
}

MarginParameter RemedySearch::parameter_from(double value) const {
  return {candidate_.parameter, candidate_.unit, value, false,
          in_exact_time(LoopFamily([this](double at) { return loop_at(at); }))};
}

/// Follows the cycles at `value` to where the last of them ends, at most `widest_factor` beyond the size.
std::optional<RemedySearch::Bracket> RemedySearch::followed_from(double value, const std::vector<Cycle>& cycles,
                                                                 bool up) {
  const MarginParameter parameter = parameter_from(value);
  MarginOptions options;
  options.predict = loop_.judging.predict;
  options.factor = up ? widest_factor * std::abs(size_ / value) : widest_factor;
  options.steps_a_branch = steps_a_branch;
  const MarginSide side = SideSearch(parameter, up, options, progress_).where_hunting_ends(cycles);
  if (side.what == MarginSide::What::unknown) {
    seen_.push_back(side.why);
    if (auto found = scanned(up, side.value == 0.0 ? value : side.value, Until::rests)) return found;
    open_ = true;
    return std::nullopt;
  }
  if (side.what != MarginSide::What::ends) {
    seen_.push_back(side.why);
    return std::nullopt;
  }
  if (side.diverges) {
    seen_.push_back("beyond " + number(side.value) + " the motion diverges");
    return std::nullopt;
  }
  const double outward = up ? 1.0 : -1.0;
  Bracket bracket{side.value, side.value};
  if (side.cycle) hunting_ = side.cycle->start;
  const double apart = std::isnan(side.error) ? 0.12 : std::clamp(2.0 * side.error, 0.25 * narrow_enough, 0.1);
  bracket.hunts *= 1.0 - outward * apart;
  bracket.rests *= 1.0 + outward * apart;
  return bracket;
}

/// A number that is absent: from the smallest of some values at which the loop hunts as it does without it.
std::optional<RemedySearch::Bracket> RemedySearch::followed_from_nothing() {
  for (const double share : {1e-2, 1e-3, 1e-4, 1e-5}) {
    const double value = share * size_;
    const auto loop = loop_at(value);
    const auto exact = loop ? in_exact_time(*loop) : std::nullopt;
    if (!exact || stopped()) return std::nullopt;
    std::vector<Cycle> cycles;
    const PredictOptions& options = loop_.judging.predict;
    for (const Cycle& one : loop_.cycles) {
      if (one.stable != true) continue;
      auto settled = settled_from(*exact, one.start, *options.search, options);
      if (settled && settled->shot && settled->shot->cycle.stable == true)
        cycles.push_back(std::move(settled->shot->cycle));
    }
    if (!cycles.empty()) {
      hunting_ = cycles.front().start;
      return followed_from(value, cycles, true);
    }
    if (judged(value, Care::quick) == Hunts::yes) return scanned(true, value, Until::rests);
  }
  return Bracket{1e-5 * size_, 0.0};  // it hunts at none of them: any will do
}

std::optional<RemedySearch::Bracket> RemedySearch::followed(bool up) {
  if (!loop_.followable) return scanned(up, candidate_.own, Until::rests);
  if (candidate_.own == 0.0) return followed_from_nothing();
  const auto stable = std::ranges::find(loop_.cycles, std::optional<bool>(true), &Cycle::stable);
  hunting_ = stable->start;
  return followed_from(candidate_.own, loop_.cycles, up);
}

/// Values outwards from one at which it hunts (or rests) to the first at which it does not.
std::optional<RemedySearch::Bracket> RemedySearch::scanned(bool up, double from, Until until) {
  const double end = up ? widest_factor * size_ : size_ / widest_factor,
               begin = from == 0.0 ? size_ / widest_factor : from;
  const int steps = std::max(1, static_cast<int>(std::ceil(a_decade * std::abs(std::log10(end / begin)))));
  double last = from;
  int diverging = 0, open = 0;
  for (int k = from == 0.0 ? 0 : 1; k <= steps && !stopped(); ++k) {
    const double value = begin * std::pow(end / begin, static_cast<double>(k) / steps);
    if (progress_) progress_(static_cast<double>(k) / steps);
    if (!candidate_.parts(value)) break;
    const Hunts here = judged(value, Care::quick);
    if (until == Until::rests && here == Hunts::no) return Bracket{value, last};
    if (until == Until::hunts && (here == Hunts::yes || here == Hunts::diverges))
      return Bracket{last, value, here == Hunts::diverges};
    open = here == Hunts::undecided || here == Hunts::neutral ? open + 1 : 0;
    if (open == 2 || (open > 0 && until == Until::hunts)) {
      open_ = true;
      seen_.push_back("from " + number(last) + " on simulations do not decide");
      return std::nullopt;
    }
    diverging = here == Hunts::diverges ? diverging + 1 : 0;
    if (diverging == 2) {
      seen_.push_back("from " + number(last) + " on the motion diverges");
      return std::nullopt;
    }
    last = value;
  }
  if (until == Until::rests) seen_.push_back("no value up to " + number(last) + " ends it");
  return std::nullopt;
}

/// The nearer edge of the two sides; of two as near, that of the larger magnitude.
std::optional<RemedySearch::Bracket> RemedySearch::nearest() {
  using Way = RemedyCandidate::Way;
  std::optional<Bracket> best;
  const auto distance = [&](const Bracket& one) {
    return candidate_.own == 0.0 ? 0.0 : std::abs(std::log(one.rests / candidate_.own));
  };
  for (const bool up : {true, false}) {
    if (up ? candidate_.way == Way::down : candidate_.way == Way::up || candidate_.own == 0.0) continue;
    if (auto one = followed(up); one && (!best || distance(*one) < distance(*best))) {
      best = std::move(one);
      best->hunting = hunting_;
    }
    if (stopped()) return std::nullopt;
  }
  if (!best && candidate_.way != Way::up && candidate_.own != 0.0 && judged(0.0) == Hunts::no) return Bracket{0.0, 0.0};
  return best;
}

/// Moves either side away from the other until predict() judges both as they should be.
bool RemedySearch::widen(Bracket& bracket) {
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
      const Hunts here = judged(value);
      const bool rests = here == Hunts::no, hunting = here == Hunts::yes || here == Hunts::diverges;
      if (to_rest ? rests : hunting) {
        side = value;
        return true;
      }
      if (!to_rest && rests) bracket.rests = value;
      if (to_rest && hunting) bracket.hunts = value;
    }
    return false;
  };
  bool hunts_beyond = false;
  const double before = bracket.hunts;
  if (!find(true, bracket.rests)) return false;
  hunts_beyond = bracket.hunts != before;
  return hunts_beyond || find(false, bracket.hunts);
}

/// Both sides judged by predict(), and 1e-3 apart.
bool RemedySearch::confirm(Bracket& bracket) {
  constexpr int rounds = 4;
  for (int i = 0; i < rounds; ++i) {
    if (!widen(bracket) || !narrow(bracket)) return false;
    if (!look_beyond(bracket)) return !stopped();
  }
  return false;
}

/// True if it hunts again just beyond an edge: the bracket is moved there.
bool RemedySearch::look_beyond(Bracket& bracket) {
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
bool RemedySearch::narrow(Bracket& bracket) {
  while (std::abs(std::log(bracket.rests / bracket.hunts)) > 1.5 * narrow_enough) {
    if (stopped()) return false;
    const double middle = bracket.hunts * std::sqrt(bracket.rests / bracket.hunts);
    const double value = rounded_away(middle, bracket.hunts);
    if (value == bracket.rests) break;
    const Hunts here = judged(value);
    if (here == Hunts::undecided || here == Hunts::neutral) return false;
    (here == Hunts::no ? bracket.rests : bracket.hunts) = value;
  }
  return true;
}

void RemedySearch::locate_far_edge(Remedy& remedy, const Bracket& near) {
  const bool up = is_outward(near.rests, near.hunts);
  std::optional<Bracket> far;
  if (loop_.followable) {
    const MarginParameter parameter = parameter_from(near.rests);
    MarginOptions options;
    options.predict = loop_.judging.predict;
    options.factor = std::max(
        1.01, up ? std::abs(widest_factor * size_ / near.rests) : std::abs(near.rests * widest_factor / size_));
    options.scan_per_decade = a_decade;
    options.steps_a_branch = steps_a_branch;
    const MarginSide side = SideSearch(parameter, up, options, progress_).where_hunting_begins();
    if (side.what == MarginSide::What::begins && side.value != near.rests) {
      const double outward = up ? 1.0 : -1.0,
                   apart = std::isnan(side.error) ? 0.1 : std::clamp(2.0 * side.error, 0.25 * narrow_enough, 0.1);
      far = Bracket{side.value * (1.0 - outward * apart), side.value * (1.0 + outward * apart)};
      if (side.cycle) hunting_ = side.cycle->start;
    } else if (side.diverges) {
      far = Bracket{near.rests, side.value, true};
    } else if (side.what == MarginSide::What::unknown) {
      remedy.why += "; beyond it simulations do not decide";
    }
  } else {
    far = scanned(up, near.rests, Until::hunts);
  }
  if (!far || stopped()) return;
  const Trace kept = run_;
  if (confirm(*far)) {
    remedy.edges.push_back(far->rests);
    remedy.beyond.push_back(far->hunts);
    const bool diverges = far->diverges || judged(far->hunts) == Hunts::diverges;
    remedy.why += "; beyond " + number(far->rests, digits) + (diverges ? " the motion diverges" : " it hunts again");
  } else {
    remedy.why += "; near " + number(far->hunts) + " it no longer rests, the edge was not confirmed";
  }
  run_ = kept;
}

Remedy RemedySearch::nothing_found() const {
  Remedy remedy{candidate_, false};
  if (stopped()) {
    remedy.ends = std::nullopt;
    remedy.why = "interrupted";
    return remedy;
  }
  if (open_) remedy.ends = std::nullopt;
  for (const auto& one : seen_) remedy.why += (remedy.why.empty() ? "" : "; ") + one;
  if (remedy.why.empty()) remedy.why = "no other value is valid";
  return remedy;
}

Remedy RemedySearch::run() {
  auto edge = nearest();
  if (!edge) return nothing_found();
  Remedy remedy{candidate_, true};
  if (edge->hunts == 0.0) {
    if (edge->rests == 0.0)
      remedy.why =
          "only 0 ends it: " + (seen_.empty() ? std::string("it hunts at every other value tried") : seen_.back());
    else
      remedy.why = "rests at every value tried, down to " + number(edge->rests);
    remedy.value = edge->rests;
    if (judged(edge->rests) != Hunts::no) remedy.ends = std::nullopt;
    remedy.after = run_;
    return remedy;
  }
  hunting_ = edge->hunting;
  if (!confirm(*edge)) {
    remedy.ends = std::nullopt;
    remedy.why = stopped() ? "interrupted"
                           : "hunting ends near " + number(edge->rests) +
                                 " on the cycle that was followed, but `predict` does not confirm it on both sides";
    return remedy;
  }
  remedy.value = edge->rests;
  remedy.edges.push_back(edge->rests);
  remedy.beyond.push_back(edge->hunts);
  remedy.why = "hunts at " + short_number(edge->hunts, digits) + ", no longer at " + number(edge->rests, digits);
  locate_far_edge(remedy, *edge);
  remedy.after = run_;
  return remedy;
}

}  // namespace limcycle
