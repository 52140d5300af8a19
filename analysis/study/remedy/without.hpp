#pragma once
#include <optional>

#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Takes off all that holds the integral back.
void free_integral(Pid& pid);

/// The same loop without one of its features; empty if it has none, or if the rest is not a valid loop.

/// Integral action of controllers, of integrator blocks, and of blocks with a feed-through and a pole at the origin.
std::optional<LoopParts> without_integral_action(LoopParts parts);
/// Stiction and the falling part of the friction curve: Fs = Fc, or a measured curve at its least force.
std::optional<LoopParts> without_falling_friction(LoopParts parts);
/// True if a friction law has a measured curve.
bool friction_is_measured(LoopParts parts);
/// Dead times of plants and blocks, and sampling.
std::optional<LoopParts> without_delay(LoopParts parts);
/// The steps in which sampled controllers read and command.
std::optional<LoopParts> without_quanta(LoopParts parts);
/// Relays: a saturation in their place that reaches the same level at twice `swing`, the amplitude of the relay's
/// input.
std::optional<LoopParts> without_relay(LoopParts parts, double swing);
/// Friction compensation.
std::optional<LoopParts> without_compensation(LoopParts parts);
/// With a straight line in place of every valve-stiction element.
std::optional<LoopParts> without_sticking_valve(LoopParts parts);
/// Limits of the command, and saturations.
std::optional<LoopParts> without_limits(LoopParts parts);

}  // namespace limcycle
