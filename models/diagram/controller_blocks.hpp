#pragma once
#include <vector>

#include "limcycle/models/diagram/assemble.hpp"
#include "limcycle/models/diagram/diagram.hpp"
#include "limcycle/models/element/of_controllers/sampled.hpp"

namespace limcycle {

/// Adds the blocks of a controller of the five slots, which reads the error `e` and, if it is a cascade, the block
/// "plant"; returns its command. On a computer its parts are elements with a clock (see Sampled), each of which comes
/// after those that it reads, so that they do at one tick what they do in one run.
SignalSum through_controller(std::vector<Block>& blocks, const Controller& controller, SignalSum e, Clock clock);

/// Adds the impulses of a PID that has some, by the error as it is measured, to the command.
void add_impulses(std::vector<Block>& blocks, const Controller& controller, SignalSum error, SignalSum& command);

/// The same for a cascade.
SignalSum through_cascade(std::vector<Block>& blocks, const Cascade& cascade, SignalSum e, Clock clock);

/// The difference equations of a controller at the ticks of a clock.
StateSpace discrete_of(const Controller& controller, const Sampling& sampling);

/// Its equations with a derivative over one sample in place of that over n, behind a mean of n: on average a lag of
/// (n - 1)/2 samples.
ControllerModel model_behind_window(const Controller& controller, const Sampling& sampling);

/// A reading on an encoder, held until the next one: of every tick of the clock, or every n-th.
Element encoder(const Sampling& sampling, double every);

/// The continuous block that acts on average as this controller does at the ticks of a clock.
Block averaged_block(std::string name, std::string path, ControllerModel model, double sample_time, SignalSum e);

/// The difference equations of a part of a controller at the ticks of its clock. `of_states`: the states of the
/// continuous part; what X has more is past inputs.
Sampled<double> on_computer(const Sampling& sampling, const StateSpace& discrete, Eigen::Index of_states);

}  // namespace limcycle
