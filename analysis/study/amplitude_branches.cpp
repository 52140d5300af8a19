#include "limcycle/analysis/study/amplitude_branches.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "limcycle/analysis/frequency/describing_function.hpp"

namespace limcycle {
namespace {

constexpr double step_ratio = 1.15;  ///< between neighbouring samples: two turns closer than this are unseen
constexpr double at_a_turn = 1e-10;  ///< by so much may the wanted size be beyond a turn, for roundings of a root there
constexpr double near_zero =
    1e-9;  ///< the share of the smallest sample that stands for 0, where a gain may be infinite
constexpr std::size_t kept = 20'000;  ///< frequencies whose turns are remembered

/// Where a function turns that does so once between `low` and `high`, by the golden section.
double turning_point(const AmplitudeBranches::Size& s, bool maximum, double low, double high) {
  constexpr double golden = 0.6180339887498949;
  const auto better = [&](double x, double y) { return maximum ? x > y : x < y; };
  double a = high - golden * (high - low), b = low + golden * (high - low), at_a = s(a), at_b = s(b);
  for (int i = 0; i < 80 && high - low > 4e-16 * high; ++i) {  // a size that nearly vanishes turns in a sharp dip
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

/// Where a monotone function takes a value that it has between two places: regula falsi that keeps both ends moving
/// (Dowell and Jarratt, 1971, the Illinois rule after them), with a bisection wherever that is slow.
double place_of(const AmplitudeBranches::Size& s, double wanted, AmplitudeBranches::Turn from,
                AmplitudeBranches::Turn to) {
  double low = from.amplitude, high = to.amplitude, f_low = from.size - wanted, f_high = to.size - wanted;
  if (f_low == 0.0) return low;
  for (int i = 0; i < 200 && high - low > 4e-16 * high; ++i) {
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

}  // namespace

namespace {

/// Where a function begins to exist and where it turns, from 0 to the end of the range.
std::vector<AmplitudeBranches::Turn> sampled_turns(const AmplitudeBranches::Size& s, std::pair<double, double> range) {
  using Turn = AmplitudeBranches::Turn;
  if (!(range.second > 0.0)) return {{0.0, 0.0}};
  std::vector<Turn> found;
  std::optional<bool> rising;
  Turn two_before{}, before{};
  for (double a = near_zero * range.first; before.amplitude < range.second; a = std::max(a * step_ratio, range.first)) {
    const Turn here{a, s(a)};
    if (!std::isfinite(here.size)) {
      before.amplitude = a;
      continue;
    }
    if (found.empty()) {
      found.push_back(here);
    } else if (here.size != before.size) {
      const bool now = here.size > before.size;
      if (rising && *rising != now) {
        const double at = turning_point(s, *rising, two_before.amplitude, a);
        found.push_back({at, s(at)});
      }
      rising = now;
    }
    two_before = before.amplitude > 0.0 ? before : here;
    before = here;
  }
  return found;
}

}  // namespace

std::vector<AmplitudeBranches::Turn> AmplitudeBranches::turns(const Size& s, std::pair<double, double> range,
                                                              double frequency, double accuracy) {
  const std::pair name{frequency, accuracy};
  {
    const std::lock_guard lock(guard_);
    if (const auto known = known_.find(name); known != known_.end()) return known->second;
  }
  auto found = sampled_turns(s, range);
  const std::lock_guard lock(guard_);
  if (known_.size() >= kept) known_.clear();
  return known_.insert_or_assign(name, std::move(found)).first->second;
}

std::vector<AmplitudeBranches::Answer> AmplitudeBranches::answers(const Size& s, std::pair<double, double> range,
                                                                  double wanted, double frequency, double accuracy) {
  if (wanted == 0.0) return {{0, 0.0}};
  std::vector<Turn> ends = turns(s, range, frequency, accuracy);
  if (ends.empty()) return {};
  double last = std::max({range.second, wanted, 2.0 * ends.back().amplitude});
  for (int i = 0; i < 100 && s(last) < wanted; ++i) last *= 2.0;
  ends.push_back({last, s(last)});
  std::vector<Answer> found;
  for (std::size_t k = 0; k + 1 < ends.size() && static_cast<int>(k) < most; ++k) {
    const auto [least, largest] = std::minmax(ends[k].size, ends[k + 1].size);
    if (!(wanted >= least * (1.0 - at_a_turn) && wanted <= largest * (1.0 + at_a_turn))) continue;
    found.push_back({static_cast<int>(k), place_of(s, std::clamp(wanted, least, largest), ends[k], ends[k + 1])});
  }
  return found;
}

ElementReach::ElementReach(const Element<double>& element)
    : output_(std::visit([](const auto& e) { return e.scales().output; }, element)) {
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
  // Beyond ten times what can come back the output no longer matters, or is in proportion to the input.
  const double high = 10.0 * std::max(bend, comes_back);
  return {std::max(0.5 * std::min(bend, comes_back), 1e-6 * high), high};
}

}  // namespace limcycle
