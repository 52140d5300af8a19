#include "limcycle/analysis/study/balance/amplitude_branches.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "limcycle/analysis/frequency/describing_function/describing_function.hpp"

namespace limcycle {
namespace {

constexpr double step_ratio = 1.15;  ///< between neighbouring samples: two turns closer than this are not resolved
constexpr double at_a_turn = 1e-10;  ///< relative excess of the wanted size beyond a turn permitted for rounding
constexpr double near_zero =
    1e-9;  ///< the share of the smallest sample that stands for 0, where a gain may be infinite
constexpr std::size_t most_remembered = 20'000;  ///< frequencies whose turns are remembered

/// Useful relative width of a bracket for an amplitude when the function is known only to `accuracy`: in narrower
/// brackets bisection would follow its errors.
double narrowest(double accuracy) { return std::max(4e-16, 1e-3 * accuracy); }

/// Turning point of a function that turns once between `low` and `high`, by golden section, to a relative `width`.
double turning_point(const AmplitudeBranches::Size& s, bool maximum, double low, double high, double width) {
  constexpr double golden = 0.6180339887498949;
  const auto better = [&](double x, double y) { return maximum ? x > y : x < y; };
  double a = high - golden * (high - low), b = low + golden * (high - low), at_a = s(a), at_b = s(b);
  for (int i = 0; i < 80 && high - low > width * high; ++i) {  // a size that nearly vanishes turns in a sharp dip
    if (better(at_a, at_b)) {
      high = b, b = a, at_b = at_a;
      a = high - golden * (high - low), at_a = s(a);
    } else {
      low = a, a = b, at_a = at_b;
      b = low + golden * (high - low), at_b = s(b);
    }
  }
  return 0.5 * (low + high);
}

/// Place where a monotone function takes a value between those at two places: regula falsi that keeps both ends moving
/// (Dowell and Jarratt, 1971, the Illinois rule after them), with a bisection wherever that is slow.
double place_of(const AmplitudeBranches::Size& s, double wanted, AmplitudeBranches::Turn from,
                AmplitudeBranches::Turn to, double narrow) {
  double low = from.amplitude, high = to.amplitude, f_low = from.size - wanted, f_high = to.size - wanted;
  if (f_low == 0.0) return low;
  for (int i = 0; i < 200 && high - low > narrow * high; ++i) {
    const double width = high - low;
    for (int k = 0; k < 3 && f_low != f_high; ++k) {
      const double mid = std::clamp(low - f_low * (high - low) / (f_high - f_low), low, high);
      const double f = s(mid) - wanted;
      if (f == 0.0) return mid;
      if ((f < 0.0) == (f_low < 0.0))
        low = mid, f_low = f, f_high *= k == 0 ? 1.0 : 0.5;
      else
        high = mid, f_high = f, f_low *= k == 0 ? 1.0 : 0.5;
    }
    if (high - low < 0.5 * width) continue;
    const double mid = 0.5 * (low + high), f = s(mid) - wanted;
    ((f < 0.0) == (f_low < 0.0) ? low : high) = mid;
    ((f < 0.0) == (f_low < 0.0) ? f_low : f_high) = f;
  }
  return 0.5 * (low + high);
}

/// Start of the function's domain and its turning points, from 0 to the end of the range.
AmplitudeBranches::Sampled sample(const AmplitudeBranches::Size& s, std::pair<double, double> range, double width) {
  using Turn = AmplitudeBranches::Turn;
  if (!(range.second > 0.0)) return {{{0.0, 0.0}}, {}};
  AmplitudeBranches::Sampled found;
  std::optional<bool> rising;
  Turn two_before{}, before{};
  for (double a = near_zero * range.first; before.amplitude < range.second; a = std::max(a * step_ratio, range.first)) {
    const Turn here{a, s(a)};
    if (!std::isfinite(here.size)) {
      before.amplitude = a;
      continue;
    }
    found.samples.push_back(here);
    if (found.turns.empty()) {
      found.turns.push_back(here);
    } else if (here.size != before.size) {
      const bool now = here.size > before.size;
      if (rising && *rising != now) {
        const double at = turning_point(s, *rising, two_before.amplitude, a, width);
        found.turns.push_back({at, s(at)});
      }
      rising = now;
    }
    two_before = before.amplitude > 0.0 ? before : here;
    before = here;
  }
  return found;
}

/// Narrows a branch to the two samples that enclose a value, so that the search for it is short.
void narrow(const std::vector<AmplitudeBranches::Turn>& samples, double wanted, AmplitudeBranches::Turn& from,
            AmplitudeBranches::Turn& to) {
  const bool rises = to.size > from.size;
  for (const AmplitudeBranches::Turn& one : samples) {
    if (!(one.amplitude > from.amplitude && one.amplitude < to.amplitude)) continue;
    const bool before = rises ? one.size <= wanted : one.size >= wanted;
    if (!before) {
      to = one;
      return;
    }
    from = one;
  }
}

}  // namespace

AmplitudeBranches::Sampled AmplitudeBranches::sampled(const Size& s, std::pair<double, double> range, double frequency,
                                                      double accuracy) {
  const std::pair name{frequency, accuracy};
  {
    const std::lock_guard lock(guard_);
    if (const auto known = known_.find(name); known != known_.end()) return known->second;
  }
  Sampled found = sample(s, range, narrowest(accuracy));
  const std::lock_guard lock(guard_);
  if (known_.size() >= most_remembered) known_.clear();
  return known_.insert_or_assign(name, std::move(found)).first->second;
}

std::vector<AmplitudeBranches::Answer> AmplitudeBranches::answers(const Size& s, std::pair<double, double> range,
                                                                  double wanted, double frequency, double accuracy) {
  std::vector<Answer> found;
  for (int branch = 0; branch < most; ++branch)
    if (const auto one = answer_on(branch, s, range, wanted, frequency, accuracy)) found.push_back(*one);
  return found;
}

std::optional<AmplitudeBranches::Answer> AmplitudeBranches::answer_on(int branch, const Size& s,
                                                                      std::pair<double, double> range, double wanted,
                                                                      double frequency, double accuracy) {
  if (wanted == 0.0) return branch == 0 ? std::optional(Answer{0, 0.0}) : std::nullopt;
  const Sampled known = sampled(s, range, frequency, accuracy);
  const std::vector<Turn>& ends = known.turns;
  const auto k = static_cast<std::size_t>(branch);
  if (k >= ends.size()) return std::nullopt;
  Turn to;
  if (k + 1 < ends.size()) {
    to = ends[k + 1];
  } else {
    double last = std::max({range.second, wanted, 2.0 * ends.back().amplitude});
    for (int i = 0; i < 100 && s(last) < wanted; ++i) last *= 2.0;
    to = {last, s(last)};
  }
  const auto [least, largest] = std::minmax(ends[k].size, to.size);
  if (!(wanted >= least * (1.0 - at_a_turn) && wanted <= largest * (1.0 + at_a_turn))) return std::nullopt;
  const double inside = std::clamp(wanted, least, largest);
  Turn from = ends[k];
  narrow(known.samples, inside, from, to);
  return Answer{branch, place_of(s, inside, from, to, narrowest(accuracy))};
}

ElementReach::ElementReach(const Element& element) : output_(element.scales().output) {
  constexpr double tiny = 1e-12;
  const auto gain = [&](double share) {
    DfOptions options;
    options.harmonics = 1;
    return describing_function(element, {share * output_, 1.0, 0.0}, options).gain;
  };
  const auto at_rest = gain(tiny);
  const auto changed = [&](double share) {
    const auto here = gain(share);
    return std::abs(here - at_rest) > 1e-9 * std::max(std::abs(here), std::abs(at_rest));
  };
  if (changed(2.0 * tiny)) return;
  for (double share = 4.0 * tiny; share < 1.0 / tiny && bend_ == infinite; share *= 2.0)
    if (changed(share)) bend_ = 0.5 * share * output_;
}

std::pair<double, double> ElementReach::range(double back) const {
  const double comes_back = back * output_, bend = bend_ < infinite ? bend_ : comes_back;
  // Beyond ten times the returning amplitude the output no longer matters, or is proportional to the input.
  const double high = 10.0 * std::max(bend, comes_back);
  return {std::max(0.5 * std::min(bend, comes_back), 1e-6 * high), high};
}

}  // namespace limcycle
