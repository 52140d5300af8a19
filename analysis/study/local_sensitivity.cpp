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

bool same_shape(const Loop& one, const Loop& other) {
  const auto states = [](const Element<double>& element) {
    return std::visit([](const auto& e) { return e.states(); }, element);
  };
  return one.states() == other.states() && one.delay == other.delay &&
         std::ranges::equal(one.elements, other.elements, {}, states, states);
}

/// The loops beside; nothing, with a reason, where there are none.
std::optional<ParameterNeighbours> beside(const Loop& loop, const LoopNumber& number, std::string& why) {
  const double h = neighbourhood * (number.value != 0.0 ? std::abs(number.value) : 1.0);
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
    if (auto pair = beside(loop, number, one.why)) {
      owners.push_back(all.size());
      neighbours.push_back(std::move(*pair));
    }
    all.push_back(std::move(one));
  }
  CycleDerivativeOptions options;
  options.stop = stop;
  const auto found = cycle_derivatives(loop, cycle, neighbours, options);
  for (std::size_t i = 0; i < owners.size(); ++i) {
    if (found.status == Status::converged)
      take(all[owners[i]], found.by[i]);
    else
      all[owners[i]].why = found.why.empty() ? std::string(to_string(found.status)) : found.why;
  }
  return all;
}

}  // namespace limcycle
