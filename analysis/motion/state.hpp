/// @file
/// The state vector that every stepper marches.
#pragma once

#include <vector>

namespace limcycle {

/// State of x' = f(x, t), one entry a component, in the units of the model. A std::vector because that is what
/// Boost.Odeint resizes and copies without an adapter.
using State = std::vector<double>;

}  // namespace limcycle
