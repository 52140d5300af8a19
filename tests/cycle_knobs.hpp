#pragma once
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "limcycle/analysis/orbit/derivatives/cycle_derivatives.hpp"
#include "limcycle/analysis/orbit/settle/settle.hpp"
#include "limcycle/models/element/with_memory/relay.hpp"
#include "limcycle/models/friction/bristle/lugre.hpp"
#include "limcycle/tests/loops.hpp"

/// Derivatives of cycles with respect to numbers of a loop's parts, and the same from differences of cycles.
namespace limcycle::test {

/// A number of the parts of a loop.
struct Knob {
  const char* name;
  std::function<double&(LoopParts&)> of;
};

template <class Law>
Knob of_law(const char* name, double Law::*member) {
  return {name, [member](LoopParts& parts) -> double& { return law_of<Law>(*parts.friction).*member; }};
}
template <class Type>
Knob of_plant(const char* name, double Type::*member) {
  return {name, [member](LoopParts& parts) -> double& { return std::get<Type>(parts.plant).*member; }};
}
inline Knob of_pid(const char* name, double Pid::*member) {
  return {name, [member](LoopParts& parts) -> double& { return std::get<Pid>(parts.controller).*member; }};
}
inline Knob of_relay(const char* name, double Relay<double>::*member) {
  return {name, [member](LoopParts& parts) -> double& { return law_of<Relay<double>>(*parts.element).*member; }};
}

inline double value(const LoopParts& parts, const Knob& knob) {
  LoopParts copy = parts;
  return knob.of(copy);
}

/// The loop with another value; friction stays the same in both directions.
inline Loop with(const LoopParts& parts, const Knob& knob, double to) {
  LoopParts changed = parts;
  knob.of(changed) = to;
  if (changed.friction && changed.friction->number("Fs_minus"))
    changed.friction = changed.friction->with("Fs_minus", *changed.friction->number("Fs"))
                           .with("Fc_minus", *changed.friction->number("Fc"));
  return build_loop(changed);
}

inline std::vector<ParameterNeighbours> neighbours(const LoopParts& parts, const std::vector<Knob>& knobs) {
  std::vector<ParameterNeighbours> found;
  for (const Knob& knob : knobs) {
    const double at = value(parts, knob), low = at * (1.0 - 1e-6), high = at * (1.0 + 1e-6);
    found.push_back({with(parts, knob, low), with(parts, knob, high), 0.5 * (high - low), at});
  }
  return found;
}

inline Cycle the_cycle(const Loop& loop, double displacement) {
  SettleOptions options;
  options.amplitude_floor = 1e-7;
  const auto settled = settle(loop, displaced(loop, displacement), options);
  INFO(settled.why);
  REQUIRE(settled.outcome == Outcome::cycle);
  return settled.shot->cycle;
}

struct Derived {
  Cycle cycle;
  std::vector<CycleDerivative> by;
};
inline Derived derived(const LoopParts& parts, const std::vector<Knob>& knobs, double displacement = 1.0,
                       double rtol = 1e-10) {
  const Loop loop = build_loop(parts);
  Derived result{the_cycle(loop, displacement), {}};
  CycleDerivativeOptions options;
  options.rtol = rtol;
  const auto found = cycle_derivatives(loop, result.cycle, neighbours(parts, knobs), options);
  INFO(found.why);
  REQUIRE(found.status == Status::converged);
  REQUIRE(found.by.size() == knobs.size());
  result.by = found.by;
  for (const auto& one : result.by) CHECK(one.multipliers.size() == result.cycle.multipliers.size());
  return result;
}

/// Derivatives from differences of whole solutions, of order 4: period, amplitude, and the largest multiplier.
struct Differences {
  double period, amplitude, multiplier;
};
inline Differences differences(const LoopParts& parts, const Knob& knob, const Cycle& cycle, double relative = 3e-4) {
  const double at = value(parts, knob), h = relative * at;
  const Section section = choose_section(build_loop(parts), cycle.trace);
  ShootingOptions options;
  options.rtol = 3e-13;
  options.tolerance = 1e-11;
  options.derivative_rtol = 1e-11;
  options.warm_maps = 1;
  Differences sum{0.0, 0.0, 0.0};
  for (const auto& [steps, weight] : {std::pair(1.0, 8.0), {-1.0, -8.0}, {2.0, -1.0}, {-2.0, 1.0}}) {
    const auto shot =
        shoot(with(parts, knob, at + steps * h), cycle.start, section, cycle.half_wave_symmetric, options);
    REQUIRE(shot.status == Status::converged);
    const double share = weight / (12.0 * h);
    sum.period += share * shot.cycle.period;
    sum.amplitude += share * shot.cycle.amplitude;
    if (!shot.cycle.multipliers.empty()) sum.multiplier += share * shot.cycle.multipliers[0].real();
  }
  return sum;
}

inline void check(double found, double error, double expected, double relative, double floor) {
  CAPTURE(found, error, expected);
  CHECK(std::abs(found - expected) <= relative * std::abs(expected) + floor);
  CHECK(std::abs(found - expected) <= error + floor);
}

/// Checks period and amplitude against differences: to 1e-5, and to the stated error. The floor is the error of
/// differences of numbers that are accurate to 1e-11.
inline void check_differences(const LoopParts& parts, const std::vector<Knob>& knobs, const Derived& found,
                              double accuracy = 1e-5) {
  for (std::size_t k = 0; k < knobs.size(); ++k) {
    CAPTURE(knobs[k].name);
    const auto expected = differences(parts, knobs[k], found.cycle);
    const double floor = 3e-8 / std::abs(value(parts, knobs[k]));
    check(found.by[k].period, found.by[k].period_error, expected.period, accuracy, floor * found.cycle.period);
    check(found.by[k].amplitude, found.by[k].amplitude_error, expected.amplitude, accuracy,
          floor * found.cycle.amplitude);
  }
}

inline std::vector<Knob> servo_knobs() {
  return {of_plant("mass", &Mass::mass), of_pid("kp", &Pid::kp), of_pid("ki", &Pid::ki), of_pid("kd", &Pid::kd)};
}
template <class Law>
std::vector<Knob> and_levels(std::vector<Knob> knobs) {
  knobs.push_back({"Fs", [](LoopParts& parts) -> double& { return law_of<Law>(*parts.friction).Fs; }});
  knobs.push_back({"Fc", [](LoopParts& parts) -> double& { return law_of<Law>(*parts.friction).Fc; }});
  return knobs;
}
inline std::vector<Knob> lugre_knobs() {
  using Law = LuGre<double>;
  auto knobs = and_levels<Law>(servo_knobs());
  knobs.push_back({"vs", [](LoopParts& parts) -> double& { return law_of<Law>(*parts.friction).vs; }});
  knobs.push_back(of_law<Law>("sigma0", &Law::sigma0));
  knobs.push_back(of_law<Law>("sigma1", &Law::sigma1));
  knobs.push_back(of_law<Law>("sigma2", &Law::sigma2));
  return knobs;
}
inline LoopParts belt_parts(Element friction) {
  LoopParts parts;
  parts.plant = Belt{1.0, 2.0, 0.0, 0.1};
  parts.friction = std::move(friction);
  return parts;
}
inline std::vector<Knob> belt_knobs() {
  return {of_plant("mass", &Belt::mass), of_plant("stiffness", &Belt::stiffness), of_plant("speed", &Belt::speed)};
}

}  // namespace limcycle::test
