#include "limcycle/analysis/study/local_sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "limcycle/analysis/orbit/cycle_derivatives.hpp"

namespace limcycle {
namespace {

constexpr double unknown_derivative = std::numeric_limits<double>::quiet_NaN();
constexpr double neighbourhood = 1e-6;  // relative
constexpr double distant = 8.0;         // times that, for numbers that are 0

bool same_shape(const Loop& one, const Loop& other) {
  const auto states = [](const Element<double>& element) {
    return std::visit([](const auto& e) { return e.states(); }, element);
  };
  return one.states() == other.states() && one.delay == other.delay &&
         std::ranges::equal(one.elements, other.elements, {}, states, states);
}

/// The loops beside, `far` times as far as usual; nothing, with a reason, where there are none.
std::optional<ParameterNeighbours> beside(const Loop& loop, const LoopNumber& number, double far, std::string& why) {
  const double h = far * neighbourhood * (number.value != 0.0 ? std::abs(number.value) : 1.0);
  auto low = number.loop_at(number.value - h), high = number.loop_at(number.value + h);
  if (!low && !high) {
    why = "no value beside it is valid";
    return std::nullopt;
  }
  if (!low || !high) {  // a border: the other side is the loop itself
    if (!low) low = loop;
    if (!high) high = loop;
  }
  if (!same_shape(loop, *low) || !same_shape(loop, *high)) {
    why = "beside this value the loop is of another order";
    return std::nullopt;
  }
  const bool border = number.loop_at(number.value - h).has_value() != number.loop_at(number.value + h).has_value();
  return ParameterNeighbours{std::move(*low), std::move(*high), border ? 0.5 * h : h, number.value};
}

/// Derivatives from two distances: of a loop that moves smoothly they differ by as little as the distances are.
bool agree(const CycleDerivative& near, const CycleDerivative& far) {
  const auto close = [](double a, double b, double error) {
    return std::abs(a - b) <= 0.01 * std::abs(a) + 10.0 * error;
  };
  return close(near.period, far.period, near.period_error + far.period_error) &&
         close(near.amplitude, far.amplitude, near.amplitude_error + far.amplitude_error);
}

void take(LocalSensitivity& into, const CycleDerivative& by) {
  into.amplitude = by.amplitude;
  into.period = by.period;
  const auto relative = [](double error, double value) { return value != 0.0 ? error / std::abs(value) : 0.0; };
  into.error = std::max(relative(by.amplitude_error, by.amplitude), relative(by.period_error, by.period));
  for (const auto& multiplier : by.multipliers)
    into.multipliers.push_back(multiplier.value_or(std::complex<double>(unknown_derivative, unknown_derivative)));
}

}  // namespace

std::vector<LocalSensitivity> local_sensitivities(const Loop& loop, const Cycle& cycle,
                                                  const std::vector<LoopNumber>& numbers,
                                                  const std::function<bool()>& stop) {
  std::vector<LocalSensitivity> all;
  std::vector<ParameterNeighbours> neighbours;
  std::vector<std::size_t> owners;
  for (const auto& number : numbers) {
    LocalSensitivity one{number.path,        number.unit, number.value,       unknown_derivative,
                         unknown_derivative, {},          unknown_derivative, {}};
    // A number that is 0 may stand for something absent (a velocity that nothing fades over): what that does as soon as
    // it is there is no derivative, and is found by looking from two distances.
    for (const double far : {1.0, distant}) {
      if (far != 1.0 && number.value != 0.0) break;
      auto pair = beside(loop, number, far, one.why);
      if (!pair) break;
      owners.push_back(all.size());
      neighbours.push_back(std::move(*pair));
    }
    all.push_back(std::move(one));
  }
  CycleDerivativeOptions options;
  options.stop = stop;
  const auto found = cycle_derivatives(loop, cycle, neighbours, options);
  for (std::size_t i = 0; i < owners.size(); ++i) {
    LocalSensitivity& one = all[owners[i]];
    const bool seen_twice = i + 1 < owners.size() && owners[i + 1] == owners[i];
    if (found.status != Status::converged)
      one.why = found.why.empty() ? std::string(to_string(found.status)) : found.why;
    else if (seen_twice && !agree(found.by[i], found.by[i + 1]))
      one.why = "at 0 it stands for something absent, and the loop leaps where it comes in";
    else
      take(one, found.by[i]);
    if (seen_twice) ++i;
  }
  return all;
}

}  // namespace limcycle
