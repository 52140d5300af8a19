#pragma once
#include <concepts>

#include "limcycle/models/element/concepts.hpp"

namespace limcycle {

/// Rate of a state that is linear in it: dz/dt = source - decay z, decay >= 0.
template <class S>
struct LinearRate {
  S source{}, decay{};
};

/// Output as a function of that state: stiffness z + damping dz/dt + rest.
template <class S>
struct LinearOutput {
  S stiffness{}, damping{}, rest{};
};

/// Optional: an element without modes and with one state in which it is linear; `linear_rate` and `linear_output` are
/// equivalent to `rate` and `output`. Its periodic state under prescribed motion is found in one pass.
/// `is_linear_in_state()`: true if the parameters make it so; `has_constant_damping()`: true if `damping` and
/// `stiffness` are numbers, and `rest` a number times the input rate.
template <class E, class S>
concept LinearInState = requires(const E e, const Input<S> in) {
  { e.linear_rate(in) } -> std::same_as<LinearRate<S>>;
  { e.linear_output(in) } -> std::same_as<LinearOutput<S>>;
  { e.is_linear_in_state() } -> std::same_as<bool>;
  { e.has_constant_damping() } -> std::same_as<bool>;
};

}  // namespace limcycle
