#include "limcycle/analysis/study/remedy/remedy_search.hpp"

#include <algorithm>
#include <cmath>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/continuation/one_sided_margin.hpp"
#include "limcycle/analysis/study/predict/in_exact_time.hpp"

namespace limcycle {
namespace {

constexpr double widest_factor = 100.0;  ///< factor on the present value, or on the size of an absent one, either way
constexpr int a_decade = 3;
constexpr long steps_a_branch = 1'500'000;
constexpr double accuracy_of_branch = 1e-5;  ///< of cycles that only lead to an edge, which predict() confirms

bool is_outward(double value, double from) { return std::abs(value) > std::abs(from); }

}  // namespace

RemedySearch::RemedySearch(const RemedyCandidate& candidate, const HuntingLoop& loop,
                           std::function<void(double)> progress)
    : candidate_(candidate),
      loop_(loop),
      size_(candidate.is_absent() ? loop.sizes.of(candidate.measure) : candidate.own),
      progress_(std::move(progress)),
      edge_(candidate, loop) {}

std::string RemedySearch::number(double value, int shown) const {
  return short_number(value, shown) + (candidate_.unit == "1" ? "" : " " + candidate_.unit);
}

MarginParameter RemedySearch::parameter_from(double value) const {
  return {candidate_.parameter, candidate_.unit, value, false,
          in_exact_time(LoopFamily([this](double at) { return edge_.loop_at(at); }))};
}

/// Follows the cycles at `value` to where the last of them ends, at most `widest_factor` beyond the size.
std::optional<Bracket> RemedySearch::followed_from(double value, const std::vector<Cycle>& cycles, bool up) {
  const MarginParameter parameter = parameter_from(value);
  MarginOptions options;
  options.predict = loop_.judging.predict;
  options.factor = widest_factor * std::abs(up ? size_ / value : value / size_);
  options.steps_a_branch = steps_a_branch;
  options.accuracy = accuracy_of_branch;
  const MarginSide side = OneSidedMargin(parameter, up, options, progress_).where_hunting_ends(cycles);
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
  return around(side, up, true);
}

/// About the value of a side, by its error.
Bracket RemedySearch::around(const MarginSide& side, bool up, bool rests_beyond) {
  if (const auto loop = edge_.loop_at(side.value); side.cycle && loop) edge_.hunting = motion_state(*side.cycle, *loop);
  const double apart = std::isnan(side.error) ? 0.1 : std::clamp(2.0 * side.error, 0.25 * narrow_enough, 0.1);
  const double low = side.value * (1.0 - apart), high = side.value * (1.0 + apart);
  return up == rests_beyond ? Bracket{high, low} : Bracket{low, high};
}

/// A number that is absent: from the first of some values, ever nearer to where it begins, at which the loop hunts as
/// it does without it.
std::optional<Bracket> RemedySearch::followed_from_nothing(bool up) {
  constexpr double farthest = 1e-5;
  const auto value_at = [&](double share) { return up ? share * size_ : size_ / share; };
  for (const double share : {1e-2, 1e-3, 1e-4, farthest}) {
    const double value = value_at(share);
    const auto loop = edge_.loop_at(value);
    const auto exact = loop ? in_exact_time(*loop) : std::nullopt;
    if (!exact || edge_.stopped()) return std::nullopt;
    std::vector<Cycle> cycles;
    const PredictOptions& options = loop_.judging.predict;
    for (const Cycle& one : loop_.cycles) {
      if (one.stable != true) continue;
      auto settled = settled_from(*exact, {one.start, loop_.states}, *options.search, options);
      if (settled && settled->shot && settled->shot->cycle.stable == true)
        cycles.push_back(std::move(settled->shot->cycle));
    }
    if (!cycles.empty()) {
      edge_.hunting = motion_state(cycles.front(), *exact);
      return followed_from(value, cycles, up);
    }
    if (edge_.judged(value, HuntingEdge::Care::quick) == Hunts::yes) return scanned(up, value, Until::rests);
  }
  return Bracket{value_at(farthest), candidate_.own};  // it hunts at none of them: any will do
}

std::optional<Bracket> RemedySearch::followed(bool up) {
  if (!loop_.followable) return scanned(up, candidate_.own, Until::rests);
  if (candidate_.is_absent()) return followed_from_nothing(up);
  const auto stable = std::ranges::find(loop_.cycles, std::optional<bool>(true), &Cycle::stable);
  edge_.hunting = {stable->start, loop_.states};
  return followed_from(candidate_.own, loop_.cycles, up);
}

/// Values outwards from one at which it hunts (or rests) to the first at which it does not.
std::optional<Bracket> RemedySearch::scanned(bool up, double from, Until until) {
  const double smallest = size_ / widest_factor, largest = widest_factor * size_;
  const double end = up ? largest : smallest, begin = from == 0.0 ? smallest : std::isinf(from) ? largest : from;
  const int steps = std::max(1, static_cast<int>(std::ceil(a_decade * std::abs(std::log10(end / begin)))));
  double last = from;
  int diverging = 0, open = 0;
  for (int k = begin == from ? 1 : 0; k <= steps && !edge_.stopped(); ++k) {
    double value = begin * std::pow(end / begin, static_cast<double>(k) / steps);
    if (progress_) progress_(static_cast<double>(k) / steps);
    if (!candidate_.parts(value) && k > 0) value = std::sqrt(last * value);  // up to where values are valid
    if (!candidate_.parts(value)) break;
    const Hunts here = edge_.judged(value, HuntingEdge::Care::quick);
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
  if (until == Until::rests)
    seen_.push_back((up ? "no value up to " : "no value down to ") + number(last) + " ends it");
  return std::nullopt;
}

/// The edges of the two sides, the nearer first; of two as near, that of the larger magnitude.
std::vector<Bracket> RemedySearch::edges() {
  using Way = RemedyCandidate::Way;
  std::vector<Bracket> found;
  const auto distance = [&](const Bracket& one) {
    return candidate_.is_absent() ? 0.0 : std::abs(std::log(one.rests / candidate_.own));
  };
  for (const bool up : {true, false}) {
    if (up ? candidate_.way == Way::down : candidate_.way == Way::up || candidate_.own == 0.0) continue;
    if (auto one = followed(up)) {
      one->hunting = edge_.hunting;
      found.push_back(std::move(*one));
    }
    if (edge_.stopped()) return {};
  }
  std::ranges::stable_sort(found, {}, distance);
  if (found.empty() && candidate_.way != Way::up && !candidate_.is_absent() && edge_.judged(0.0) == Hunts::no)
    found.push_back({0.0, 0.0});
  return found;
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
    options.accuracy = accuracy_of_branch;
    const MarginSide side = OneSidedMargin(parameter, up, options, progress_).where_hunting_begins();
    if (side.what == MarginSide::What::begins && side.value != near.rests) {
      far = around(side, up, false);
    } else if (side.diverges) {
      far = Bracket{near.rests, side.value, true};
    } else if (side.what == MarginSide::What::unknown) {
      remedy.why += "; beyond it simulations do not decide";
    }
  } else {
    far = scanned(up, near.rests, Until::hunts);
  }
  if (!far || edge_.stopped()) return;
  const Trace kept = edge_.run;
  if (edge_.confirm(*far)) {
    remedy.edges.push_back(far->rests);
    remedy.beyond.push_back(far->hunts);
    const bool diverges = far->diverges || edge_.judged(far->hunts) == Hunts::diverges;
    remedy.why +=
        "; beyond " + number(far->rests, edge_digits) + (diverges ? " the motion diverges" : " it hunts again");
  } else {
    remedy.why += "; near " + number(far->hunts) + " it no longer rests, the edge was not confirmed";
  }
  edge_.run = kept;
}

Remedy RemedySearch::nothing_found() const {
  Remedy remedy{candidate_, false};
  if (edge_.stopped()) {
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
  const auto all = edges();
  Remedy remedy = all.empty() ? nothing_found() : at_edge(all.front());
  // The nearer one may be no edge of what `predict` finds.
  if (all.size() > 1 && !remedy.ends && !edge_.stopped())
    if (Remedy other = at_edge(all.back()); other.ends == true) return other;
  return remedy;
}

/// It rests however small, or however large, the number is.
Remedy RemedySearch::without_edge(const Bracket& edge) {
  Remedy remedy{candidate_, true};
  remedy.value = edge.rests;
  if (edge.rests == 0.0)
    remedy.why =
        "only 0 ends it: " + (seen_.empty() ? std::string("it hunts at every other value tried") : seen_.back());
  else
    remedy.why =
        "rests at every value tried, " + std::string(edge.hunts == 0.0 ? "down" : "up") + " to " + number(edge.rests);
  if (edge_.judged(edge.rests) != Hunts::no) remedy.ends = std::nullopt;
  remedy.after = edge_.run;
  return remedy;
}

/// The last valid value, to 1e-3, of a number whose range ends between these two.
std::optional<double> RemedySearch::end_of_range(const Bracket& edge) const {
  constexpr double near = 1e-3;
  if (edge_.stopped() || candidate_.parts(edge.rests)) return std::nullopt;
  double valid = edge.hunts, beyond = edge.rests;
  while (std::abs(beyond / valid - 1.0) > near) {
    const double middle = 0.5 * (valid + beyond);
    (candidate_.parts(middle) ? valid : beyond) = middle;
  }
  return valid;
}

Remedy RemedySearch::at_edge(Bracket edge) {
  if (edge.hunts == 0.0 || std::isinf(edge.hunts)) return without_edge(edge);
  Remedy remedy{candidate_, true};
  edge_.hunting = edge.hunting;
  const Bracket found = edge;
  const auto take = [&](const Bracket& one) {
    remedy.value = one.rests;
    remedy.edges.push_back(one.rests);
    remedy.beyond.push_back(one.hunts);
    remedy.why =
        "hunts at " + short_number(one.hunts, edge_digits) + ", no longer at " + number(one.rests, edge_digits);
    if (one.has_gap) remedy.why += "; `predict` does not decide all values between them";
  };
  if (edge_.confirm(edge)) {
    take(edge);
    locate_far_edge(remedy, edge);
  } else if (auto wide = edge_.stopped() ? std::nullopt : edge_.well_apart(found)) {
    take(*wide);
  } else if (const auto last = end_of_range(found); last && edge_.judged(*last) == Hunts::yes) {
    remedy.ends = false;
    remedy.why = "it hunts all the way to " + number(*last) + ", where its range ends";
    return remedy;
  } else {
    remedy.ends = std::nullopt;
    remedy.why = edge_.stopped()
                     ? "interrupted"
                     : "hunting ends near " + number(edge.rests) +
                           " on the cycle that was followed, but `predict` does not confirm it on both sides";
    return remedy;
  }
  remedy.after = edge_.run;
  return remedy;
}

}  // namespace limcycle
