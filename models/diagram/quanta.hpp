#pragma once
#include "limcycle/models/diagram/diagram.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// True if the quanta of sampled controllers are all that is not linear in a loop, so that a continuous one in its
/// place must have them too.
bool has_only_quanta(const LoopParts& parts);

/// ".encoder", ".encoder2", ...: what the readings of a block are named after it, from 0.
std::string encoder_name(std::size_t number);

/// A quantizer of that step behind a signal, as the block `name`; returns what reads it.
SignalSum through_quantizer(std::vector<Block>& blocks, const std::string& name, const std::string& path, double step,
                            SignalSum signal);

/// The diagram, its controllers not yet on a clock, with the quanta of their readings of plants as quantizers, or of
/// the commands of those that read exactly: a balance of two quantizers would take a minute.
Diagram with_quantizers(Diagram diagram);

/// The parts with a filter of half a sample for each derivative that has none: it cannot differentiate a quantizer.
LoopParts with_filtered_derivatives(LoopParts parts);

}  // namespace limcycle
