#pragma once
#include "limcycle/models/diagram/diagram.hpp"

namespace limcycle {

/// Appends what stands between a controller and its plant (friction compensation at the body `on`, limit of the
/// command, lag) as blocks of their own, named PREFIXcompensation, PREFIXsaturation and PREFIXlag, and returns the
/// signal behind them.
SignalSum through_actuator(std::vector<Block>& blocks, const Actuator& actuator, const std::string& prefix,
                           const std::string& path, SignalSum signal, const std::string& on);

/// Lets a block read another one in the place of a block with one output.
void read_instead(Block& block, const std::string& name, const std::string& other);

/// The diagram with those parts of its controllers as blocks of their own: readers of a controller then read the last
/// of them. Positions of the blocks that stood before stay.
Diagram expanded(Diagram diagram);

}  // namespace limcycle
