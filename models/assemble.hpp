#pragma once
#include "limcycle/models/element/output_rate.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Joins the parts of a loop without checking them: where validate() reports an error, the result is wrong. The states
/// are those of the loop at rest, for any rate of the reference.
Loop assemble(const LoopParts& parts);

/// Element that computes the rate of the output of an element on the error; empty where that rate is not available.
std::optional<OutputRate<double>> output_rate(const Element& element);

/// True if the error e = r - y is used; false for friction without a controller or an element in series.
bool uses_error(const LoopParts& parts);

}  // namespace limcycle
