#include "limcycle/analysis/energy/passivity/threshold.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "limcycle/analysis/energy/passivity/storage_slopes.hpp"

namespace limcycle {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

Passive verdict_of(const Element& law, const ThresholdOptions& options) {
  if (options.verdict) return options.verdict(law);
  return one_state_verdict(law, options.top_speed, options.stop);
}

/// Interval in which a yes-or-no question changes its answer, from two numbers with different answers.
struct Interval {
  double low, high;
};
Interval bisect(const std::function<bool(double)>& is, double low, double high, double accuracy, bool logarithmic) {
  const bool at_low = is(low);
  const double least = logarithmic ? 0.0 : 1e-3 * accuracy * (high - low);  // for a change at 0
  for (int k = 0; k < 200; ++k) {
    if (high - low <= std::max(least, accuracy * std::max(std::abs(low), std::abs(high)))) break;
    const double middle = logarithmic && low > 0.0 ? std::sqrt(low) * std::sqrt(high) : 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (is(middle) == at_low ? low : high) = middle;
  }
  return {low, high};
}

class ThresholdSearch {
 public:
  ThresholdSearch(const LawFamily& family, const ThresholdOptions& options) : family_(family), options_(options) {}

  /// No verdict if the value is not valid.
  std::optional<Passive> at(double value) {
    if (options_.stop && options_.stop()) {
      result.status = Status::interrupted;
      return Passive::undecided;
    }
    const auto law = family_(value);
    if (!law) return std::nullopt;
    ++result.evaluations;
    return verdict_of(*law, options_);
  }

  /// The change between two values with the verdicts below and above; if the middle is undecided, both its ends.
  void between(double low, double high, Passive below, Passive above) {
    const auto until = [&](Passive wanted) {
      return bisect([&](double value) { return at(value) == wanted; }, low, high, options_.accuracy, false);
    };
    const Interval first = until(below);
    double end = first.high;
    if (at(first.high) != above) {
      low = first.low;
      end = until(above).high;
    }
    result.changes.push_back({0.5 * (first.low + end), 0.5 * (end - first.low), below, above});
  }

  Threshold result;

 private:
  const LawFamily& family_;
  const ThresholdOptions& options_;
};

}  // namespace

LawFamily family_of(const Element& element, std::string_view key) {
  for (std::size_t i = 0; i < element.parameters().size(); ++i) {
    if (element.parameters()[i].key != key || !element.number(key)) continue;
    return [element, key = std::string(key),
            range = element.parameters()[i].range](double value) -> std::optional<Element> {
      if (!std::isfinite(value) || !range.contains(value)) return std::nullopt;
      const Element changed = element.with(key, value);
      return changed.validate() ? std::nullopt : std::optional(changed);
    };
  }
  throw std::invalid_argument(std::string(element.kind()) + " has no number called " + std::string(key));
}

Threshold passivity_threshold(const LawFamily& family, double low, double high, const ThresholdOptions& options) {
  if (!(low < high) || !std::isfinite(low) || !std::isfinite(high) || (options.logarithmic && !(low > 0.0)))
    throw std::invalid_argument("a range of thresholds must ascend, from above 0 if logarithmic: " +
                                std::to_string(low) + " to " + std::to_string(high));
  if (options.scan < 2) throw std::invalid_argument("a scan needs two values, not " + std::to_string(options.scan));
  ThresholdSearch search(family, options);
  struct Known {
    double value;
    Passive passive;
  };
  std::vector<Known> known;
  std::vector<double> unknown;
  for (int k = 0; k < options.scan; ++k) {
    const double part = static_cast<double>(k) / (options.scan - 1);
    const double value = k == 0                  ? low
                         : k == options.scan - 1 ? high
                         : options.logarithmic   ? low * std::pow(high / low, part)
                                                 : low + part * (high - low);
    const auto passive = search.at(value);
    if (search.result.status == Status::interrupted) return search.result;
    if (k == 0) search.result.at_low = passive.value_or(Passive::undecided);
    if (k == options.scan - 1) search.result.at_high = passive.value_or(Passive::undecided);
    if (!passive || *passive == Passive::undecided)
      unknown.push_back(value);
    else
      known.push_back({value, *passive});
  }
  for (std::size_t i = 1; i < known.size(); ++i)
    if (known[i].passive != known[i - 1].passive)
      search.between(known[i - 1].value, known[i].value, known[i - 1].passive, known[i].passive);
  const auto is_in_change = [&](double value) {
    return std::ranges::any_of(search.result.changes, [value](const ThresholdChange& change) {
      return std::abs(value - change.value) <= change.error;
    });
  };
  if (search.result.status == Status::converged && !std::ranges::all_of(unknown, is_in_change))
    search.result.status = Status::incomplete;
  return search.result;
}

LeastDamping least_sigma2(const Element& element, const ThresholdOptions& options) {
  const LawFamily family = family_of(element, "sigma2");
  ThresholdSearch search(family, options);
  const Passive undamped = search.at(0.0).value_or(Passive::undecided);
  if (undamped == Passive::yes) return {};
  if (undamped == Passive::undecided) return {nothing, nothing, Status::incomplete};
  const Scales scales = element.scales();
  const double unit = std::isfinite(scales.velocity) ? scales.output / scales.velocity : scales.output;
  double low = 0.0, high = 1e-3 * unit;
  for (;; high *= 10.0) {
    const Passive verdict = search.at(high).value_or(Passive::undecided);
    if (search.result.status == Status::interrupted) return {nothing, nothing, Status::interrupted};
    if (verdict == Passive::yes) break;
    if (verdict == Passive::no) low = high;
    if (high > 1e12 * unit) return {infinite, 0.0, Status::incomplete};
  }
  search.between(low, high, Passive::no, Passive::yes);
  return {search.result.changes.front().value, search.result.changes.front().error, search.result.status};
}

PassiveSpeed passive_speed(const Element& element, const ThresholdOptions& options) {
  bool stopped = false;
  const auto verdict = [&](double speed) {
    stopped = stopped || (options.stop && options.stop());
    return one_state_verdict(element, speed, options.stop);
  };
  const Passive always = verdict(infinite);
  if (always == Passive::yes) return {infinite, 0.0, Status::converged};
  const double scale = OneStateLaw(element, infinite).velocity_scale();
  const Passive slowest = verdict(1e-9 * scale);
  if (stopped) return {nothing, nothing, Status::interrupted};
  if (slowest != Passive::yes) return {0.0, 0.0, slowest == Passive::no ? Status::converged : Status::incomplete};
  if (verdict(1e12 * scale) == Passive::yes) return {1e12 * scale, infinite, Status::incomplete};
  const Interval left = bisect([&](double speed) { return verdict(speed) == Passive::yes; }, 1e-9 * scale, 1e12 * scale,
                               options.accuracy, true);
  if (stopped) return {nothing, nothing, Status::interrupted};
  return {0.5 * (left.low + left.high), 0.5 * (left.high - left.low), Status::converged};
}

}  // namespace limcycle
