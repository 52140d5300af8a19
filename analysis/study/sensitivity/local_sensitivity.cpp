#include "limcycle/analysis/study/sensitivity/local_sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "limcycle/analysis/orbit/derivatives/cycle_derivatives.hpp"
#include "limcycle/analysis/short_number.hpp"
#include "limcycle/analysis/study/balance/roots/df_roots.hpp"

namespace limcycle {
namespace {

constexpr double unknown_derivative = std::numeric_limits<double>::quiet_NaN();
constexpr double neighbourhood = 1e-6;  // relative
constexpr double distant = 8.0;         // factor on that, for numbers that are 0

bool same_shape(const Loop& one, const Loop& other) {
  const auto states = [](const Element& element) { return element.states(); };
  return one.states() == other.states() && one.delay == other.delay &&
         std::ranges::equal(one.elements, other.elements, {}, states, states);
}

/// The neighbouring loops, at `far` times the usual distance; nothing, with a reason, if there are none.
std::optional<ParameterNeighbours> beside(const Loop& loop, const LoopNumber& number, double far, std::string& why) {
  const double h = far * neighbourhood * (number.value != 0.0 ? std::abs(number.value) : 1.0);
  auto low = number.loop_at(number.value - h), high = number.loop_at(number.value + h);
  if (!low && !high) {
    why = "no neighbouring value is valid";
    return std::nullopt;
  }
  if (!low || !high) {  // a border: the other side is the loop itself
    if (!low) low = loop;
    if (!high) high = loop;
  }
  if (!same_shape(loop, *low) || !same_shape(loop, *high)) {
    why = "undefined at " + short_number(number.value) + ", where the order of the loop changes";
    return std::nullopt;
  }
  const bool border = number.loop_at(number.value - h).has_value() != number.loop_at(number.value + h).has_value();
  return ParameterNeighbours{std::move(*low), std::move(*high), border ? 0.5 * h : h, number.value};
}

/// Neighbours in each number, and the index of that number. A number that is 0 may stand for something absent (a
/// velocity over which nothing fades): the abrupt effect of a value above 0 is no derivative, and is detected by two
/// distances.
class Neighbourhood {
 public:
  Neighbourhood(const Loop& loop, const std::vector<LoopNumber>& numbers) : why_(numbers.size()) {
    for (std::size_t i = 0; i < numbers.size(); ++i)
      for (const double far : {1.0, distant}) {
        if (far != 1.0 && numbers[i].value != 0.0) break;
        auto pair = beside(loop, numbers[i], far, why_[i]);
        if (!pair) break;
        owners_.push_back(i);
        pairs_.push_back(std::move(*pair));
      }
  }

  /// Results of `derive` for all pairs. If it fails because a number that is 0 makes the motion switch differently for
  /// any value above 0 (a dead zone), it is called for the other numbers without such ones, and for each of those
  /// alone.
  template <class Derive>
  auto derive_apart(Derive&& derive) const {
    Told<std::decay_t<decltype(derive(pairs_))>> told{derive(pairs_), std::vector<std::string>(pairs_.size())};
    if (told.found.status != Status::stalled) return told;
    const auto ask = [&](const std::vector<std::size_t>& which) {
      std::vector<ParameterNeighbours> some;
      some.reserve(which.size());
      for (const std::size_t k : which) some.push_back(pairs_[k]);
      return derive(some);
    };
    const auto put = [&](const auto& from, const std::vector<std::size_t>& which) {
      for (std::size_t j = 0; j < which.size(); ++j)
        if (from.status == Status::converged)
          told.found.by[which[j]] = from.by[j];
        else
          told.failed[which[j]] = from.why;
    };
    std::vector<std::size_t> firm;
    for (std::size_t k = 0; k < pairs_.size(); ++k)
      if (pairs_[k].value != 0.0) firm.push_back(k);
    auto without = ask(firm);
    if (firm.size() == pairs_.size() || without.status != Status::converged) return told;
    told.found = without;
    told.found.by.assign(pairs_.size(), {});
    put(without, firm);
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      if (pairs_[k].value != 0.0) continue;
      std::vector<std::size_t> alone{k};
      if (k + 1 < pairs_.size() && owners_[k + 1] == owners_[k]) alone.push_back(++k);
      put(ask(alone), alone);
    }
    return told;
  }

  /// Passes on the results of derive_apart: take(i, derivative) for each number i, or leave(i, why). For a smooth
  /// dependence, derivatives from two distances differ only as much as the distances suggest: agree(near, far).
  void hand_out(const auto& told, auto&& agree, auto&& take, auto&& leave) const {
    const auto& found = told.found;
    for (std::size_t i = 0; i < why_.size(); ++i)
      if (!why_[i].empty()) leave(i, why_[i]);
    for (std::size_t k = 0; k < owners_.size(); ++k) {
      const std::size_t i = owners_[k];
      const bool twice = k + 1 < owners_.size() && owners_[k + 1] == i;
      if (!why_[i].empty()) continue;
      if (found.status != Status::converged)
        leave(i, found.why.empty() ? std::string(to_string(found.status)) : found.why);
      else if (!told.failed[k].empty())
        leave(i, told.failed[k]);
      else if (twice && !agree(found.by[k], found.by[k + 1]))
        leave(i, "undefined at 0: the term is absent there, and the loop changes abruptly when it appears");
      else
        take(i, found.by[k]);
      if (twice) ++k;
    }
  }

 private:
  template <class Derivatives>
  struct Told {
    Derivatives found;
    std::vector<std::string> failed;  ///< for a pair alone
  };

  std::vector<std::string> why_;
  std::vector<ParameterNeighbours> pairs_;
  std::vector<std::size_t> owners_;
};

bool close(double a, double b, double error) { return std::abs(a - b) <= 0.01 * std::abs(a) + 10.0 * error; }

void take(LocalSensitivity& into, const CycleDerivative& by) {
  into.amplitude = by.amplitude;
  into.period = by.period;
  const auto relative = [](double error, double value) { return value != 0.0 ? error / std::abs(value) : 0.0; };
  into.error = std::max(relative(by.amplitude_error, by.amplitude), relative(by.period_error, by.period));
  for (const auto& multiplier : by.multipliers)
    into.multipliers.push_back(multiplier.value_or(std::complex<double>(unknown_derivative, unknown_derivative)));
  into.first_harmonic = by.first_harmonic;
  into.first_harmonic_error = by.first_harmonic_error;
  into.offset = by.offset;
  into.offset_error = by.offset_error;
  into.amplitude_error = by.amplitude_error;
  into.period_error = by.period_error;
}

}  // namespace

std::vector<LocalSensitivity> local_sensitivities(const Loop& loop, const Cycle& cycle,
                                                  const std::vector<LoopNumber>& numbers,
                                                  const std::function<bool()>& stop) {
  std::vector<LocalSensitivity> all;
  all.reserve(numbers.size());
  constexpr double none = unknown_derivative;
  for (const auto& number : numbers)
    all.push_back(
        {number.path, number.unit, number.value, none, none, {}, none, {}, none, none, none, none, none, none});
  const Neighbourhood around(loop, numbers);
  CycleDerivativeOptions options;
  options.stop = stop;
  around.hand_out(
      around.derive_apart(
          [&](std::span<const ParameterNeighbours> pairs) { return cycle_derivatives(loop, cycle, pairs, options); }),
      [](const CycleDerivative& near, const CycleDerivative& far) {
        return close(near.period, far.period, near.period_error + far.period_error) &&
               close(near.amplitude, far.amplitude, near.amplitude_error + far.amplitude_error);
      },
      [&](std::size_t i, const CycleDerivative& by) { take(all[i], by); },
      [&](std::size_t i, const std::string& why) { all[i].why = why; });
  return all;
}

std::vector<PredictedOscillation> predicted_sensitivities(const Loop& loop, const SearchBox& box,
                                                          const std::vector<LoopNumber>& numbers,
                                                          std::vector<std::string>& notes,
                                                          const std::function<bool()>& stop) {
  if (const auto why = FirstHarmonicBalance::not_applicable(loop)) {
    notes.push_back("the describing function predicts nothing to differentiate: " + *why);
    return {};
  }
  const auto roots = find_df_roots(loop, FirstHarmonicBalance(loop), box, stop).roots;
  if (roots.empty()) notes.emplace_back("the describing function predicts no oscillation to differentiate");
  const Neighbourhood around(loop, numbers);
  DfDerivativeOptions options;
  options.stop = stop;
  std::vector<PredictedOscillation> all;
  for (const Root& root : roots) {
    const auto told = around.derive_apart([&](std::span<const ParameterNeighbours> pairs) {
      return prediction_derivatives(loop, root.amplitude, root.frequency, pairs, options);
    });
    PredictedOscillation one{told.found, {}};
    if (one.found.status == Status::undefined) {
      notes.push_back("derivatives of describing functions: " + one.found.why);
      return all;
    }
    for (const auto& number : numbers) one.numbers.push_back({number.path, number.unit, number.value, {}, {}});
    around.hand_out(
        told,
        [](const PredictionDerivative& near, const PredictionDerivative& far) {
          return close(near.amplitude, far.amplitude, near.amplitude_error + far.amplitude_error) &&
                 close(near.frequency, far.frequency, near.frequency_error + far.frequency_error);
        },
        [&](std::size_t i, const PredictionDerivative& by) { one.numbers[i].by = by; },
        [&](std::size_t i, const std::string& why) { one.numbers[i].why = why; });
    one.found.by.clear();
    all.push_back(std::move(one));
  }
  return all;
}

std::vector<ThresholdNumber> threshold_sensitivities(const Loop& loop, const MarginSide& side,
                                                     const std::vector<LoopNumber>& numbers, std::size_t own,
                                                     const std::function<bool()>& stop) {
  std::vector<LoopNumber> others = numbers;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(own));
  std::vector<ThresholdNumber> all;
  all.reserve(others.size());
  for (const auto& number : others) all.push_back({number.path, number.unit, number.value, {}, {}});
  const auto without = [&](const std::string& why) {
    for (auto& one : all) one.why = why;
    return all;
  };
  if (!side.cycle || !side.event) return without("the branch was not followed to a fold or a change of stability");
  std::string why;
  const auto pair = beside(loop, numbers.at(own), 1.0, why);
  if (!pair) return without(why);
  const Neighbourhood around(loop, others);
  CycleDerivativeOptions options;
  options.stop = stop;
  around.hand_out(
      around.derive_apart([&](std::span<const ParameterNeighbours> pairs) {
        return threshold_derivatives(loop, *side.cycle, *side.event, *pair, pairs, options);
      }),
      [](const ThresholdDerivative& near, const ThresholdDerivative& far) {
        return close(near.value, far.value, near.error + far.error);
      },
      [&](std::size_t i, const ThresholdDerivative& by) { all[i].by = by; },
      [&](std::size_t i, const std::string& reason) { all[i].why = reason; });
  return all;
}

}  // namespace limcycle
