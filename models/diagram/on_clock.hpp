#pragma once
#include "limcycle/models/diagram/assemble.hpp"

namespace limcycle {

/// True if a controller of the diagram runs on a computer.
bool is_sampled(const Diagram& diagram);

/// True if a sampled controller has difference equations: the inverse of its sample time is none of its poles.
bool has_differences(const Controller& controller);

/// The rule that the sampled controllers of a diagram break together: their sample times are whole multiples of the
/// shortest, so that their clocks tick together.
std::optional<BrokenRule> broken_clocks(const Diagram& given);

/// The diagram with what stands for its sampled controllers (see Clock): elements with a clock, read through an encoder
/// where they have an input_step; or, on average, continuous blocks behind the dead time of hold and computation. That
/// dead time delays the plants, exactly, if it is the same on every way from a plant to a sampled controller and none
/// goes by another; else each of them has a low-pass in its place. Both are right to first order in the sample time.
Diagram on_clock(Diagram diagram, Clock clock);

}  // namespace limcycle
