#pragma once
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Joins the parts of a loop, unchecked: what validate() refuses comes out wrong. The states are those of the loop at
/// rest, whatever the rate of the reference.
Loop assemble(const LoopParts& parts);

/// What stands for the rate of the output of an element on the error; empty where that rate is not to be had.
std::optional<OutputRate<double>> output_rate(const Element<double>& element);

/// Is the error e = r - y used at all? Without a controller it is not, unless an element in series takes it.
bool uses_error(const LoopParts& parts);

}  // namespace limcycle
